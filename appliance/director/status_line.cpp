#include "appliance/director/status_line.h"

#include <algorithm>
#include <chrono>
#include <string>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

double secondsOf(rt::Nanoseconds time) {
  return std::chrono::duration<double>(std::max(time, rt::Nanoseconds{0})).count();
}

/// The mode, with the age of the shown moment; none for the newest one.
Phrase modeOf(const Shot& shot) {
  constexpr rt::Nanoseconds kShownAsZero = std::chrono::milliseconds(5);
  const bool newest = shot.delay < kShownAsZero;
  const double age = secondsOf(shot.delay);
  switch (shot.mode) {
    case Mode::kLive:
      break;
    case Mode::kDelayed:
      return phrase<Word::kShownDelayed>(age);
    case Mode::kFrozen:
      return newest ? phrase<Word::kShownFrozen>() : phrase<Word::kShownFrozenAgo>(age);
    case Mode::kSweep:
      return newest ? phrase<Word::kShownSweep>() : phrase<Word::kShownSweepAgo>(age);
    case Mode::kSlow:
      return newest ? phrase<Word::kShownSlow>(nameOf(shot.rate))
                    : phrase<Word::kShownSlowAgo>(nameOf(shot.rate), age);
  }
  return phrase<Word::kShownLive>();
}

Phrase reasonOf(const Shot& shot) {
  const std::uint64_t camera = std::uint64_t{shot.camera_wanted} + 1;
  switch (shot.substitute) {
    case Substitute::kNone:
      break;
    case Substitute::kLost:
      return phrase<Word::kBadgeLost>(camera);
    case Substitute::kNoFrame:
      return phrase<Word::kBadgeNoFrame>(camera);
    case Substitute::kCannotSee:
      return phrase<Word::kBadgeCannotSee>(camera);
  }
  return {};
}

Phrase comparisonOf(const Shot& shot) {
  if (shot.second_missing) return phrase<Word::kShownWithNone>();
  const std::uint64_t view = std::uint64_t{shot.second.camera} + 1;
  if (shot.second_earlier == rt::Nanoseconds::zero()) return phrase<Word::kShownWith>(view);
  return phrase<Word::kShownWithEarlier>(view, secondsOf(shot.second_earlier));
}

/// Why the picture is not the requested one, and what is shown instead.
std::string badgeOf(const Shot& shot) {
  std::string reason = textOf(reasonOf(shot));
  if (shot.camera_shown != shot.camera_wanted) {
    const std::uint64_t camera = std::uint64_t{shot.camera_shown} + 1;
    return reason + ": " + textOf(phrase<Word::kBadgeShowing>(camera));
  }
  if (shot.trigger != 0) return reason + ": " + textOf(phrase<Word::kBadgeShowingLast>());
  return reason;
}

}  // namespace

StatusText statusText(const Shot& shot, std::uint32_t cameras) {
  StatusText line{.text = textOf(modeOf(shot))};
  const auto state = [&line](const std::string& statement) {
    line.text += kStatementGap + statement;
  };
  const std::uint64_t view = std::uint64_t{shot.camera_wanted} + 1;
  state(textOf(phrase<Word::kShownView>(view, cameras)));
  if (shot.second_missing || shot.second.trigger != 0) state(textOf(comparisonOf(shot)));
  if (shot.at_history_end) state(textOf(phrase<Word::kShownMemoryEnd>()));
  if (shot.trigger == 0) state(textOf(phrase<Word::kShownNothingYet>()));
  if (shot.substitute != Substitute::kNone) state(badgeOf(shot));
  line.warning = shot.substitute != Substitute::kNone || shot.trigger == 0;
  return line;
}

}  // namespace appliance
