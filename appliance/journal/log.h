#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <sys/stat.h>

#include "appliance/words/word.h"

namespace appliance {

enum class LogLevel : std::uint8_t {
  kError,
  kWarning,
  kNotice,  ///< what a maintainer looks for: a trouble that ended, a screen that was given away
  kInfo,
};

/// One line of the journal.
struct JournalLine {
  LogLevel level = LogLevel::kInfo;
  std::string text;
  Word word = Word::kNothing;  ///< its id stands before the text: "[camera-silent] camera 7 ..."

  friend bool operator==(const JournalLine&, const JournalLine&) = default;
};

/// Lines for people, on standard error: with syslog levels if the journal reads them, else with
/// words.
///
/// Threads  main.
/// RT       Not safe.
void log(LogLevel level, std::string_view line);

void log(const JournalLine& line);

/// The line as it is written, without its level.
[[nodiscard]] std::string withId(const JournalLine& line);

inline void logInfo(std::string_view line) {
  log(LogLevel::kInfo, line);
}
inline void logWarning(std::string_view line) {
  log(LogLevel::kWarning, line);
}
inline void logError(std::string_view line) {
  log(LogLevel::kError, line);
}

/// Whether @p file is the journal's stream, as $JOURNAL_STREAM names it: "DEVICE:INODE". Terminals
/// and other programs inherit the variable, so that its presence alone says nothing.
[[nodiscard]] bool isJournal(const char* journal_stream, const struct stat& file);

}  // namespace appliance
