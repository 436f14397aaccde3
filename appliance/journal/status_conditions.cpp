#include "appliance/journal/status_conditions.h"

#include <string_view>

namespace appliance {
namespace {

using Now = Condition::Now;

/// A camera that is in trouble holds its condition until it streams: what it is on the way back is
/// no news.
Condition ofCamera(std::size_t index, const CameraStatus& camera) {
  const std::string who = cameraTitle(index, camera.name);
  const bool wrong = camera.trouble != CameraTrouble::kNone;
  const bool streams = camera.state == CameraState::kStreaming;
  return {.key = "camera " + std::to_string(index + 1),
          .kind = std::to_string(static_cast<int>(camera.trouble)),
          .now = wrong     ? Now::kHolds
                 : streams ? Now::kOver
                           : Now::kUnclear,
          .text = who + camera.reason,
          .end = who + textOf(phrase<Word::kCameraStreams>()),
          .word = camera.reason_word,
          .end_word = Word::kCameraStreams};
}

Condition ofScreen(const Status& status) {
  const std::string state = textOf(phrase<Word::kScreenState>(nameOf(status.screen)));
  const std::string& message = status.screen_message;
  const bool shows = status.screen == hal::ScreenState::kShowing;
  return {.key = "screen",
          .kind = state + message,
          .now = shows && message.empty() ? Now::kOver : Now::kHolds,
          .level =
              status.screen == hal::ScreenState::kReleased ? LogLevel::kNotice : LogLevel::kWarning,
          .text = message.empty() ? state : state + ": " + message,
          .end = state,
          .word = message.empty() ? Word::kScreenState : status.screen_word,
          .end_word = Word::kScreenState};
}
/// A lock is the good condition; the way to the first one is no news.
Condition ofGenlock(const Status& status) {
  const GenlockStatus& genlock = status.genlock;
  const bool locked = genlock.state == GenlockState::kLocked;
  const std::string line = "genlock " + status.genlock_text;
  return {.key = "genlock",
          .now = locked ? Now::kHolds : Now::kOver,
          .level = LogLevel::kNotice,
          .text = line,
          .end_level = LogLevel::kWarning,
          .end = line,
          .word = status.genlock_word,
          .end_word = status.genlock_word,
          .begins = genlock.unlocks + (locked ? 1 : 0)};
}

/// No ratio of trigger and screen that could lock.
Condition ofRatio(const Status& status) {
  return {.key = "genlock ratio",
          .now = status.genlock.reason == GenlockReason::kRatio ? Now::kHolds : Now::kOver,
          .level = LogLevel::kNotice,
          .text = "genlock " + status.genlock_text,
          .end = "genlock: " + textOf(phrase<Word::kGenlockFits>()),
          .word = status.genlock_word,
          .end_word = Word::kGenlockFits};
}

/// Remarks differ by their words. What a backend adds to a word is another kind of the same
/// condition if it differs in more than its numbers. Notes of a backend differ by their texts.
Condition ofRemark(const Remark& remark) {
  const bool own = remark.word == Word::kNothing || isNote(remark.word);
  return {.key = remark.key + ": " +
                 (own ? withoutNumbers(remark.text) : std::string(idOf(remark.word))),
          .kind = withoutNumbers(remark.text),
          .text = remark.text,
          .end = textOf(phrase<Word::kOver>(remark.text)),
          .word = remark.word,
          .end_word = own ? Word::kOver : remark.word};
}

}  // namespace

std::vector<Condition> conditionsOf(const Status& status) {
  std::vector<Condition> conditions;
  for (std::size_t i = 0; i < status.cameras.size(); ++i)
    conditions.push_back(ofCamera(i, status.cameras[i]));
  for (const Remark& remark : status.degraded) conditions.push_back(ofRemark(remark));
  conditions.push_back(ofScreen(status));
  conditions.push_back(ofGenlock(status));
  conditions.push_back(ofRatio(status));
  return conditions;
}

}  // namespace appliance
