#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace hal::openni {

/// Puts depth and colour pictures of one moment together by their stamps. Depth is what counts:
/// each one goes on, without colour if that has not come when the next depth has. Pure.
template <class Picture>
class PairMaker {
 public:
  /// @p apart_us: stamps further apart are other moments; half a period.
  explicit PairMaker(std::uint64_t apart_us) : apart_us_(apart_us) {}

  /// @p emit(depth, std::optional<Picture> colour) takes what is ready, in order.
  template <class Emit>
  void onDepth(std::uint64_t stamp_us, Picture picture, const Emit& emit) {
    if (depth_) emit(std::move(depth_->picture), std::optional<Picture>{});
    depth_ = Waiting{stamp_us, std::move(picture)};
    match(emit);
  }
  template <class Emit>
  void onColour(std::uint64_t stamp_us, Picture picture, const Emit& emit) {
    colour_ = Waiting{stamp_us, std::move(picture)};
    match(emit);
  }
  /// What waits will get no partner any more.
  template <class Emit>
  void flush(const Emit& emit) {
    if (depth_) emit(std::move(depth_->picture), std::optional<Picture>{});
    depth_.reset();
    colour_.reset();
  }

 private:
  struct Waiting {
    std::uint64_t stamp_us;
    Picture picture;
  };

  template <class Emit>
  void match(const Emit& emit) {
    if (!depth_ || !colour_) return;
    const std::uint64_t a = depth_->stamp_us;
    const std::uint64_t b = colour_->stamp_us;
    if ((a > b ? a - b : b - a) > apart_us_) return;
    emit(std::move(depth_->picture), std::optional<Picture>(std::move(colour_->picture)));
    depth_.reset();
    colour_.reset();
  }

  std::uint64_t apart_us_;
  std::optional<Waiting> depth_;
  std::optional<Waiting> colour_;
};

}  // namespace hal::openni
