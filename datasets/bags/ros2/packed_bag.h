// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/bags/chunks/temporary_copy.h"

namespace raymoval {

/// A recording in a file that Zstandard packed as a whole. It is unpacked to a temporary file when
/// it is opened, and read there.
class PackedBag : public Bag {
 public:
  using Open = std::function<std::unique_ptr<Bag>(const std::filesystem::path&)>;
  /// @throws as `TemporaryCopy`, and what `open` throws of the file inside
  PackedBag(const std::filesystem::path& path, const Open& open)
      : packed_(path), copy_(packed_), bag_(open(copy_.path())) {}

  [[nodiscard]] const std::filesystem::path& path() const override { return packed_.path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return bag_->topics(); }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return bag_->recorded(topic, index);
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override {
    return bag_->message(topic, index);
  }
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override {
    return bag_->message_head(topic, index, most);
  }
  [[nodiscard]] std::vector<std::string> damage() const override {
    std::vector<std::string> all = bag_->damage();
    if (!copy_.problem().empty()) {
      all.insert(all.begin(),
                 path().string() + ": " + copy_.problem() + "; what stands before is read.");
    }
    return all;
  }
  /// The recording inside.
  [[nodiscard]] const Bag& inside() const { return *bag_; }

 private:
  BagFile packed_;
  TemporaryCopy copy_;
  std::unique_ptr<Bag> bag_;
};

}  // namespace raymoval
