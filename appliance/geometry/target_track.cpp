#include "appliance/geometry/target_track.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace appliance {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kLongestGap = 500ms;    // between two measurements of one movement
constexpr rt::Nanoseconds kLongestLead = 150ms;   // of a prediction; later it stands still
constexpr rt::Nanoseconds kVelocityOver = 150ms;  // one measurement's noise is no movement
constexpr double kFurthest_m = 0.5;               // of a prediction from what was measured
constexpr rt::Nanoseconds kForgotten = 2s;        // a prediction this old is a guess
constexpr double kDeadBand_m = 0.005;

// A reader that looks at the oldest entries must not be overtaken while it searches.
constexpr std::uint64_t kGuard = 64;

double inSeconds(rt::Nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

bool isFinite(const TargetPoint& point) {
  return std::isfinite(point.x_m) && std::isfinite(point.y_m) && std::isfinite(point.z_m);
}

/// std::lerp stays between its ends.
TargetPoint between(const TargetPoint& a, const TargetPoint& b, double part) {
  return {.x_m = std::lerp(a.x_m, b.x_m, part),
          .y_m = std::lerp(a.y_m, b.y_m, part),
          .z_m = std::lerp(a.z_m, b.z_m, part)};
}

TargetPoint moved(const TargetPoint& from, const TargetPoint& velocity_m_s, double seconds) {
  const double furthest = velocity_m_s.vector().norm() * seconds;
  const double shortened = furthest > kFurthest_m ? seconds * kFurthest_m / furthest : seconds;
  return {.x_m = from.x_m + velocity_m_s.x_m * shortened,
          .y_m = from.y_m + velocity_m_s.y_m * shortened,
          .z_m = from.z_m + velocity_m_s.z_m * shortened};
}

}  // namespace

std::string_view nameOf(TargetOrigin origin) {
  constexpr std::array<std::string_view, 4> kNames = {"the rig's", "measured", "predicted",
                                                      "set by hand"};
  return kNames[static_cast<std::size_t>(origin)];
}

bool looksDifferent(const Target& shown, const Target& now) RT_SAFE {
  if (now.origin == TargetOrigin::kByHand || now.origin == TargetOrigin::kRig)
    return shown.point != now.point;
  if (shown.origin == now.origin && shown.revision == now.revision) return false;
  return (shown.point.vector() - now.point.vector()).norm() > kDeadBand_m;
}

void TargetTrack::put(const Entry& entry) RT_SAFE {
  Slot& slot = slots_[entry.index % kCapacity];
  slot.entry.store(entry);
  slot.at_ns.store(rt::toNs(entry.at), std::memory_order_release);
}

bool TargetTrack::measure(rt::Timestamp at, const TargetPoint& point, double confidence) RT_SAFE {
  const std::uint64_t count = count_.load(std::memory_order_relaxed);
  const bool newer =
      count == 0
          ? at > rt::Timestamp{}
          : rt::toNs(at) > slots_[(count - 1) % kCapacity].at_ns.load(std::memory_order_relaxed);
  if (!newer || !isFinite(point) || std::isnan(confidence)) {
    refused_.store(refused() + 1, std::memory_order_relaxed);  // one writer
    return false;
  }
  put({.index = count,
       .at = at,
       .point = point,
       .confidence = std::clamp(confidence, 0.0, 1.0),
       .revision = ++revision_});
  count_.store(count + 1, std::memory_order_release);
  return true;
}

bool TargetTrack::revise(rt::Timestamp at, const TargetPoint& point, double confidence) RT_SAFE {
  const Window known = window();
  const std::uint64_t after = firstAfter(at, known);
  const auto old = after > known.first ? entry(after - 1) : std::nullopt;
  if (!old || old->at != at || !isFinite(point) || std::isnan(confidence)) {
    refused_.store(refused() + 1, std::memory_order_relaxed);
    return false;
  }
  put({.index = old->index,
       .at = at,
       .point = point,
       .confidence = std::clamp(confidence, 0.0, 1.0),
       .revision = ++revision_});
  return true;
}

void TargetTrack::setByHand(const TargetPoint& point, rt::Timestamp from) {
  hand_.set(point, from);
  shared_hand_.store(hand_);
}

void TargetTrack::release(rt::Timestamp from) {
  hand_.release(from);
  shared_hand_.store(hand_);
}

TargetTrack::Window TargetTrack::window() const RT_SAFE {
  const std::uint64_t count = count_.load(std::memory_order_acquire);
  constexpr std::uint64_t kSafe = kCapacity - kGuard;
  return {.first = count > kSafe ? count - kSafe : 0, .count = count};
}

std::uint64_t TargetTrack::firstAfter(rt::Timestamp instant, Window window) const RT_SAFE {
  std::uint64_t low = window.first;
  std::uint64_t high = window.count;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto at_ns = slots_[middle % kCapacity].at_ns.load(std::memory_order_acquire);
    if (at_ns > rt::toNs(instant))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

std::optional<TargetTrack::Entry> TargetTrack::entry(std::uint64_t index) const RT_SAFE {
  const auto found = slots_[index % kCapacity].entry.tryLoad();
  return found && found->index == index ? found : std::nullopt;
}

// One writer writes one entry at a time: if that one is being revised, its neighbour is whole.
std::optional<TargetTrack::Entry> TargetTrack::atOrBefore(std::uint64_t index,
                                                          Window window) const RT_SAFE {
  if (auto found = entry(index)) return found;
  return index > window.first ? entry(index - 1) : std::nullopt;
}

std::optional<TargetTrack::Entry> TargetTrack::atOrAfter(std::uint64_t index,
                                                         Window window) const RT_SAFE {
  if (auto found = entry(index)) return found;
  return index + 1 < window.count ? entry(index + 1) : std::nullopt;
}

Target TargetTrack::predicted(const Entry& newest, rt::Timestamp instant,
                              Window window) const RT_SAFE {
  const rt::Nanoseconds age = std::max<rt::Nanoseconds>(instant - newest.at, 0ns);
  Target target{
      .point = newest.point,
      .origin = TargetOrigin::kPredicted,
      .confidence = newest.confidence * std::max(0.0, 1 - inSeconds(age) / inSeconds(kForgotten)),
      .revision = newest.revision};
  const std::uint64_t from = firstAfter(newest.at - kVelocityOver - 1ns, window);
  if (from >= newest.index) return target;  // alone: it stands
  const auto past = entry(from);
  if (!past || past->at >= newest.at) return target;
  const double seconds = inSeconds(newest.at - past->at);
  const TargetPoint velocity_m_s{.x_m = (newest.point.x_m - past->point.x_m) / seconds,
                                 .y_m = (newest.point.y_m - past->point.y_m) / seconds,
                                 .z_m = (newest.point.z_m - past->point.z_m) / seconds};
  target.point = moved(newest.point, velocity_m_s, inSeconds(std::min(age, kLongestLead)));
  target.revision = std::max(newest.revision, past->revision);
  return target;
}

std::optional<Target> TargetTrack::measured(rt::Timestamp instant) const RT_SAFE {
  const Window known = window();
  if (known.count == known.first) return std::nullopt;
  const bool newest_asked = instant == rt::Timestamp{};
  const std::uint64_t after = newest_asked ? known.count : firstAfter(instant, known);
  if (after == known.first) return std::nullopt;
  const auto before = atOrBefore(after - 1, known);
  if (!before) return std::nullopt;  // overtaken: the instant is older than the ring
  if (newest_asked || instant == before->at) {
    return Target{.point = before->point,
                  .origin = TargetOrigin::kMeasured,
                  .confidence = before->confidence,
                  .revision = before->revision};
  }
  const auto next = after < known.count ? atOrAfter(after, known) : std::nullopt;
  if (!next) return predicted(*before, instant, known);
  const rt::Nanoseconds gap = next->at - before->at;
  const bool close = gap <= kLongestGap;
  const double trust = close ? 1 : inSeconds(kLongestGap) / inSeconds(gap);
  const double part = inSeconds(instant - before->at) / inSeconds(gap);
  return Target{.point = between(before->point, next->point, part),
                .origin = close ? TargetOrigin::kMeasured : TargetOrigin::kPredicted,
                .confidence = trust * std::min(before->confidence, next->confidence),
                .revision = std::max(before->revision, next->revision)};
}

Target TargetReader::at(rt::Timestamp exposure_middle, const TargetPoint& rig_point) RT_SAFE {
  if (auto newest = track_.shared_hand_.tryLoad()) hand_ = *newest;
  const auto byHand = [](const HandTargets::Range& range) {
    return Target{.point = range.point,
                  .origin = TargetOrigin::kByHand,
                  .confidence = 1,
                  .revision = range.revision};
  };
  const HandTargets::Range* const open = hand_.open();
  const bool unknown = exposure_middle == rt::Timestamp{};
  const HandTargets::Range* const set = unknown ? open : hand_.at(exposure_middle);
  if (set != nullptr) return byHand(*set);
  if (const auto measured = track_.measured(exposure_middle)) return *measured;
  if (open != nullptr) return byHand(*open);
  return {.point = rig_point, .origin = TargetOrigin::kRig};
}

}  // namespace appliance
