// SPDX-License-Identifier: MIT
#include "benchmark/tables/cell_line.h"

#include <algorithm>

#include "benchmark/result/results.h"
#include "benchmark/tables/text/text_table.h"
#include "core/text.h"
#include "core/utf8.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr std::size_t kMostSequence = 20;
constexpr std::size_t kMostMethod = 40;
constexpr const char* kKept = "  (kept)";

std::size_t widest(const std::vector<std::string>& names, std::size_t most) {
  std::size_t width = 0;
  for (const std::string& name : names) width = std::max(width, character_count(name));
  return std::min(width, most);
}

/// "F1 0.9443", in the width of a perfect rate.
std::string rate_piece(const RateSpec& spec, const std::optional<double>& value) {
  const std::string full = fixed_text(spec.largest(), spec.decimals);
  const std::string text = value ? rate_text(spec.name, *value) : "n/a";
  return spec.name + " " + padded_left(text, full.size());
}

/// The main rates of a cell: headline rates in `headlines`, rates of kept and removed points in
/// `others`. Rates of the first protocol come first.
void collect_rates(const Cell& cell, std::vector<std::string>& headlines,
                   std::vector<std::string>& others) {
  for (const Score& score : cell.scores) {
    for (const Rate& rate : score.rates) {
      const RateSpec spec = rate_spec(rate.name);
      if (spec.role == RateRole::kHeadline) headlines.push_back(rate_piece(spec, rate.value));
      if (spec.role == RateRole::kKept || spec.role == RateRole::kRemoved) {
        others.push_back(rate_piece(spec, rate.value));
      }
    }
  }
}

}  // namespace

CellLines::CellLines(const std::vector<std::string>& sequences,
                     const std::vector<std::string>& methods, std::size_t cells)
    : cells_(cells),
      sequence_width_(widest(sequences, kMostSequence)),
      method_width_(widest(methods, kMostMethod)) {}

std::string CellLines::line(std::size_t number, const Cell& cell, bool kept) const {
  const std::string of = std::to_string(cells_);
  const auto fitted = [](const std::string& name, std::size_t width) {
    return padded(shortened_middle(name, width), width);
  };
  std::string text = "[" + padded_left(std::to_string(number), of.size()) + "/" + of + "] " +
                     fitted(cell.sequence, sequence_width_) + "  " +
                     fitted(cell.name, method_width_);
  if (!cell.ok()) {
    text += std::string("  ") + status_name(cell.status) + ": " + cell.reason;
    std::replace(text.begin(), text.end(), '\n', ' ');
    return shortened_end(text, kTerminalWidth);
  }
  std::vector<std::string> headlines, others;
  collect_rates(cell, headlines, others);
  std::vector<std::string> pieces;
  if (!headlines.empty()) pieces.push_back(headlines.front());
  if (cell.measured) {
    pieces.push_back(padded_left(fixed_text(1000.0 * cell.measured->mean_seconds, 1), 7) + " ms");
  }
  for (std::size_t i = 0; i + 1 < others.size(); i += 2) {  // One rate alone means little.
    pieces.push_back(others[i] + "  " + others[i + 1]);
  }
  if (headlines.size() > 1) {
    const std::size_t at = std::min<std::size_t>(3, pieces.size());
    pieces.insert(pieces.begin() + static_cast<std::ptrdiff_t>(at), headlines.begin() + 1,
                  headlines.end());
  }
  for (const std::string& piece : pieces) {
    const std::size_t reserved = std::string(kKept).size();
    if (character_count(text) + 2 + piece.size() + reserved > kTerminalWidth) break;
    text += "  " + piece;
  }
  return text + (kept ? kKept : "");
}

}  // namespace raymoval
