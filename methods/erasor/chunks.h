// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace raymoval::erasor_method {

/// A vector in chunks, which do not move when it grows: it is never in memory twice.
template <class Value>
class Chunks {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  Value& operator[](std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const Value& operator[](std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }

  void push_back(const Value& value) {
    if (size_ % kChunk == 0) chunks_.push_back(std::make_unique_for_overwrite<Value[]>(kChunk));
    (*this)[size_++] = value;
  }

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 16;
  std::vector<std::unique_ptr<Value[]>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace raymoval::erasor_method
