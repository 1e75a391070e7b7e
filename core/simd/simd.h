// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace raymoval {

/// The vectors that a kernel uses. Kernels are compiled once for each set, and all versions give
/// the same numbers.
enum class InstructionSet {
  kBest,   ///< The best set that this processor has, found at run time.
  kPlain,  ///< No vectors, and nothing beyond what the whole program is compiled for.
  kSse4,
  kAvx2,
};

/// The name of a set, such as "AVX2".
const char* instruction_set_name(InstructionSet set);

/// The sets that this program was compiled for and this processor has, the plainest first.
std::vector<InstructionSet> supported_instruction_sets();

/// The alignment of the widest vectors, bytes.
inline constexpr std::size_t kSimdAlignment = 64;

/// An array that vectors of any width can be loaded from. It grows as needed, and its values are
/// not initialised.
template <class Value>
class AlignedArray {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  /// Reserves memory for at least `size` values and keeps the present values.
  void require(std::size_t size) {
    if (size <= size_) return;
    const std::size_t wanted = size + size / 2;
    std::unique_ptr<Value, Free> values(static_cast<Value*>(
        ::operator new (wanted * sizeof(Value), std::align_val_t{kSimdAlignment})));
    if (size_ > 0) std::memcpy(values.get(), values_.get(), size_ * sizeof(Value));
    values_ = std::move(values);
    size_ = wanted;
  }
  [[nodiscard]] Value* data() { return values_.get(); }
  [[nodiscard]] const Value* data() const { return values_.get(); }
  Value& operator[](std::size_t i) { return values_.get()[i]; }
  const Value& operator[](std::size_t i) const { return values_.get()[i]; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(Value* values) const {
      ::operator delete (values, std::align_val_t{kSimdAlignment});
    }
  };
  std::unique_ptr<Value, Free> values_;
  std::size_t size_ = 0;
};

}  // namespace raymoval
