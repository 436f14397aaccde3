#include "appliance/director/view_choice.h"

namespace appliance {
namespace {

using Frame = ViewChoice::Frame;

/// The wanted view, or the usable one nearest to it.
template <class Usable>
std::optional<std::uint32_t> nearest(std::uint32_t cameras, std::uint32_t view,
                                     std::uint32_t shown_before, Usable usable) {
  if (usable(view)) return view;
  for (std::uint32_t away = 1; away < cameras; ++away) {
    const bool left = view >= away && usable(view - away);
    const bool right = view + away < cameras && usable(view + away);
    if (left && right) return shown_before > view ? view + away : view - away;
    if (left) return view - away;
    if (right) return view + away;
  }
  return std::nullopt;
}

/// The view's frame of a moment, or one of the few before it.
std::optional<std::uint64_t> bridged(const StoredViews& stored, std::uint32_t camera,
                                     std::uint64_t trigger) {
  for (std::uint64_t back = 0; back <= ViewChoice::kBridgedTriggers && back < trigger; ++back)
    if (stored.holds(camera, trigger - back)) return trigger - back;
  return std::nullopt;
}

/// A moment near one that no camera has.
std::optional<Frame> besideHole(const Available& at, std::uint32_t view, const Frame& last,
                                std::uint64_t trigger) {
  const auto holder = [&](std::uint64_t of) -> std::optional<Frame> {
    const auto camera = nearest(at.cameras, view, last.camera,
                                [&](std::uint32_t c) { return at.stored.holds(c, of); });
    if (!camera) return std::nullopt;
    return Frame{*camera, of};
  };
  for (std::uint64_t away = 1; away <= ViewChoice::kWidestHole_triggers; ++away) {
    if (trigger >= at.range.oldest + away) {
      if (const auto earlier = holder(trigger - away)) return earlier;
    }
    if (trigger + away <= at.range.newest) {
      if (const auto later = holder(trigger + away)) return later;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Frame> ViewChoice::live(const Available& at, std::uint32_t view, const Frame& last,
                                      rt::Timestamp now) RT_SAFE {
  const StoredViews& stored = at.stored;
  const auto stores = [&](std::uint32_t c) { return !stored.range(c).empty(); };
  const auto delivers = [&](std::uint32_t c) {
    return stored.living(c) && stores(c) && stored.sees(c);
  };
  for (std::uint32_t c = 0; c < at.cameras; ++c) steady_.note(c, delivers(c), now);
  const auto steady = [&](std::uint32_t c) { return steady_.steady(c); };
  auto camera = nearest(at.cameras, view, last.camera, steady);
  if (!camera) camera = nearest(at.cameras, view, last.camera, delivers);
  if (!camera) camera = nearest(at.cameras, view, last.camera, stores);  // the last picture stays
  if (!camera) return std::nullopt;
  const std::uint64_t newest = stored.range(*camera).newest;
  const bool backwards =
      last.camera == *camera && last.trigger > newest && stored.holds(*camera, last.trigger);
  return Frame{*camera, backwards ? last.trigger : newest};
}

std::optional<Frame> ViewChoice::played(const Available& at, std::uint32_t view, const Frame& last,
                                        std::uint64_t trigger, rt::Timestamp now) RT_SAFE {
  if (at.range.empty()) return std::nullopt;
  const auto plays = [&](std::uint32_t c) {
    return at.stored.sees(c) && bridged(at.stored, c, trigger).has_value();
  };
  for (std::uint32_t c = 0; c < at.cameras; ++c) steady_.note(c, plays(c), now);
  const auto steady = [&](std::uint32_t c) { return steady_.steady(c); };
  auto camera = nearest(at.cameras, view, last.camera, steady);
  if (!camera) camera = nearest(at.cameras, view, last.camera, plays);
  const auto shown = camera ? bridged(at.stored, *camera, trigger) : std::nullopt;
  if (!shown) return besideHole(at, view, last, trigger);
  return Frame{*camera, *shown};
}

std::optional<Frame> ViewChoice::stopped(const Available& at, std::uint32_t view, const Frame& last,
                                         std::uint64_t trigger) RT_SAFE {
  const auto holds = [&](std::uint32_t c) { return at.stored.holds(c, trigger); };
  const auto sees = [&](std::uint32_t c) { return at.stored.sees(c) && holds(c); };
  auto camera = nearest(at.cameras, view, last.camera, sees);
  if (!camera) camera = nearest(at.cameras, view, last.camera, holds);
  if (!camera) return std::nullopt;
  return Frame{*camera, trigger};
}

}  // namespace appliance
