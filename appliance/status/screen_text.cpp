#include "appliance/status/screen_text.h"

#include <cstring>
#include <string_view>

namespace appliance {

Phrase screenPhrase(const hal::ScreenStatus& screen) {
  using hal::ScreenTrouble;
  const std::string_view subject = screen.subject.data();
  const std::string_view detail = screen.detail.data();
  switch (screen.trouble) {
    case ScreenTrouble::kNone:
      break;
    case ScreenTrouble::kReleased:
      return phrase<Word::kScreenReleased>();
    case ScreenTrouble::kCardInUse:
      return phrase<Word::kScreenInUse>(subject);
    case ScreenTrouble::kCardNotPermitted:
      return phrase<Word::kScreenNotPermitted>(subject);
    case ScreenTrouble::kCardGone:
      return phrase<Word::kScreenCardGone>(subject);
    case ScreenTrouble::kNothingConnected:
      return phrase<Word::kScreenNothing>(subject);
    case ScreenTrouble::kNoCrtc:
      return phrase<Word::kScreenNoCrtc>(subject);
    case ScreenTrouble::kNoMode:
      return phrase<Word::kScreenNoMode>(subject);
    case ScreenTrouble::kModesRefused:
      return phrase<Word::kScreenModesRefused>(subject);
    case ScreenTrouble::kModeRefused:
      return phrase<Word::kScreenModeRefused>(detail, subject, std::strerror(screen.os_errno));
    case ScreenTrouble::kOtherMode:
      return phrase<Word::kScreenOtherMode>(subject, detail);
    case ScreenTrouble::kNoMemory:
      return phrase<Word::kScreenNoMemory>(detail);
    case ScreenTrouble::kNoDisplay:
      return phrase<Word::kScreenMissing>(detail);
  }
  return {};
}

}  // namespace appliance
