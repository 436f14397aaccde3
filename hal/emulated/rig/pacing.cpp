#include "hal/emulated/rig/pacing.h"

#include <algorithm>

namespace emulator {
namespace {

constexpr double kEthernetOverheadBytes = 38;
constexpr rt::Nanoseconds kLongestGroup{1'000'000};

}  // namespace

rt::Nanoseconds LinkTiming::perPacket() const {
  const double seconds = (packet_bytes + kEthernetOverheadBytes) * 8 / bits_per_second;
  return rt::Nanoseconds{static_cast<std::int64_t>(seconds * 1e9)} + packet_delay;
}

Pacing::Pacing(rt::Timestamp start, const LinkTiming& link, std::uint32_t packets,
               std::uint32_t most_at_once)
    : start_(start), per_packet_(link.perPacket()), packets_(packets) {
  const auto in_time = kLongestGroup / std::max(per_packet_, rt::Nanoseconds{1});
  group_ = static_cast<std::uint32_t>(std::clamp<std::int64_t>(in_time, 1, most_at_once));
}

Pacing::Due Pacing::next() const {
  if (next_ == 0) return {0, 1, start_};
  const std::uint32_t count = std::min(group_, packets_ - next_);
  return {next_, count, start_ + per_packet_ * (next_ + count)};
}

rt::Timestamp Pacing::scheduledEnd() const {
  return start_ + per_packet_ * packets_;
}

}  // namespace emulator
