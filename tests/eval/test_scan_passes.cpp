// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <string>

#include "eval/scan_passes.h"
#include "tests/eval/random_sequence.h"

namespace raymoval::test {
namespace {

/// Writes its name whenever it begins a pass, and a dot behind it when it ends.
class NamedVisitor : public ScanVisitor {
 public:
  /// @param waits_from the pass before which it waits for others
  NamedVisitor(char name, int passes, int waits_from, std::string& told)
      : name_(name), passes_(passes), waits_from_(waits_from), told_(told) {}
  [[nodiscard]] bool runs_last() const override { return pass_ + 1 >= waits_from_; }
  bool begin_pass(std::size_t /*slots*/) override {
    told_ += name_;
    const bool goes_on = ++pass_ <= passes_;
    if (!goes_on) told_ += '.';
    return goes_on;
  }
  void read(const CheckedScan& /*scan*/, std::size_t /*slot*/) override {}
  void take(std::size_t /*slot*/) override { ++scans; }

  int scans = 0;

 private:
  char name_;
  int passes_, waits_from_;
  std::string& told_;
  int pass_ = 0;
};

constexpr int kNever = 100;

}  // namespace

TEST_CASE("visitors that wait have their passes after the others, one by one", "[passes]") {
  const MemorySequence sequence = random_sequence({});
  const auto scans = static_cast<int>(sequence.size());
  std::string told;
  NamedVisitor a('a', 3, 2, told), b('b', 2, kNever, told), c('c', 2, 2, told);
  run_passes(sequence.input(), sequence.masks(), {&a, &b, &c});
  // All begin together; then b continues alone, then a, which came before c.
  CHECK(told == "abcbb.aaa.cc.");
  CHECK(a.scans == 3 * scans);
  CHECK(b.scans == 2 * scans);
  CHECK(c.scans == 2 * scans);
}

TEST_CASE("visitors that do not wait share all passes", "[passes]") {
  const MemorySequence sequence = random_sequence({});
  std::string told;
  NamedVisitor a('a', 2, kNever, told), b('b', 1, kNever, told);
  run_passes(sequence.input(), sequence.masks(), {&a, &b});
  CHECK(told == "abab.a.");
}

TEST_CASE("one that waits from the beginning is shown the scans all the same", "[passes]") {
  const MemorySequence sequence = random_sequence({});
  std::string told;
  NamedVisitor a('a', 0, 1, told), b('b', 1, 1, told);
  run_passes(sequence.input(), sequence.masks(), {&a, &b});
  CHECK(told == "a.bb.");
  CHECK(b.scans == static_cast<int>(sequence.size()));
}

}  // namespace raymoval::test
