#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hal/display.h"

namespace ui {

/// Flips until the caller takes them. When kKept wait, the oldest is overwritten.
class FlipList {
 public:
  static constexpr std::size_t kKept = 64;

  void push(const hal::PageFlip& flip) {
    flips_[(first_ + count_) % kKept] = flip;
    if (count_ == kKept) {
      first_ = (first_ + 1) % kKept;
    } else {
      ++count_;
    }
  }
  [[nodiscard]] std::optional<hal::PageFlip> tryPop() {
    if (count_ == 0) return std::nullopt;
    const hal::PageFlip flip = flips_[first_];
    first_ = (first_ + 1) % kKept;
    --count_;
    return flip;
  }

 private:
  std::array<hal::PageFlip, kKept> flips_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace ui
