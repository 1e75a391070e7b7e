// SPDX-License-Identifier: MIT
#include "benchmark/result/cell.h"

#include <algorithm>

namespace raymoval {
namespace {

constexpr std::pair<CellStatus, const char*> kStatusNames[] = {
    {CellStatus::kOk, "ok"},
    {CellStatus::kFailed, "failed"},
    {CellStatus::kTimeout, "timeout"},
    {CellStatus::kOutOfMemory, "out_of_memory"},
    {CellStatus::kBadData, "bad_data"}};

}  // namespace

const char* status_name(CellStatus status) {
  for (const auto& [known, name] : kStatusNames) {
    if (known == status) return name;
  }
  throw InternalError("a status of a cell has no name");
}

std::optional<CellStatus> status_called(const std::string& name) {
  for (const auto& [status, known] : kStatusNames) {
    if (known == name) return status;
  }
  return std::nullopt;
}

std::optional<double> rate_of(const std::vector<Rate>& rates, const std::string& name) {
  for (const Rate& rate : rates) {
    if (rate.name == name) return rate.value;
  }
  return std::nullopt;
}

std::optional<double> Score::rate(const std::string& name) const {
  return rate_of(rates, name);
}

const Interval* Score::interval(const std::string& rate) const {
  if (!intervals) return nullptr;
  const auto found = std::ranges::find(intervals->rates, rate, &Interval::name);
  return found == intervals->rates.end() || !found->low || !found->high ? nullptr : &*found;
}

const Score* Cell::score(const std::string& protocol) const {
  for (const Score& score : scores) {
    if (score.protocol.name == protocol) return &score;
  }
  return nullptr;
}

void Cell::fail(CellStatus why, const std::string& text) {
  status = why;
  reason = text;
  scores.clear();
  columns.reset();
  reliability.reset();
}

}  // namespace raymoval
