// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/reasons.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark/result/sealed_json.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::filesystem::path sentences_file(const std::filesystem::path& folder) {
  return folder / "reasons.json";
}

std::filesystem::path reason_file(const std::filesystem::path& folder, const Scan& scan) {
  return folder / (scan.name + ".reason");
}

bool any_from(const std::vector<std::uint8_t>& codes, std::size_t end) {
  return std::any_of(codes.begin(), codes.end(), [&](std::uint8_t code) { return code >= end; });
}

}  // namespace

void write_reasons(const std::filesystem::path& folder, const ScanSource& scans,
                   const Reasons& reasons) {
  if (reasons.empty()) return;
  write_sealed(sentences_file(folder), {{"sentences", reasons.sentences}});
  for (std::size_t i = 0; i < reasons.codes.size(); ++i) {
    const std::vector<std::uint8_t>& codes = reasons.codes[i];
    if (codes.empty()) continue;
    write_atomically(reason_file(folder, scans.load(i)),
                     {reinterpret_cast<const char*>(codes.data()), codes.size()});
  }
}

bool is_reason_file(const std::filesystem::path& name) {
  return name == sentences_file("") || name.extension() == ".reason";
}

std::vector<std::string> read_reason_sentences(const std::filesystem::path& folder) {
  const std::filesystem::path file = sentences_file(folder);
  if (!has_file(file)) return {};
  try {
    return read_sealed(file).at("sentences").get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception& error) {
    throw DataError(file.string() + ": not the reasons of a method (" + error.what() +
                    "). Run `raymoval run --keep-removals` again with the same --out.");
  }
}

std::vector<std::uint8_t> read_reasons(const std::filesystem::path& folder, const Scan& scan,
                                       std::size_t sentences) {
  const std::filesystem::path file = reason_file(folder, scan);
  if (sentences == 0 || !has_file(file)) return {};
  const std::vector<std::byte> bytes = read_bytes(file);
  std::vector<std::uint8_t> codes(bytes.size());
  std::transform(bytes.begin(), bytes.end(), codes.begin(),
                 [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
  if (codes.size() == scan.size() && !any_from(codes, sentences)) return codes;
  throw DataError(file.string() + ": does not fit its scan of " + grouped_text(scan.size()) +
                  " points. Run `raymoval run --keep-removals` again with the same --out.");
}

}  // namespace raymoval
