#pragma once

#include <cstdint>
#include <string>

#include <sys/stat.h>

#include "appliance/words/phrase.h"

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
/// words. Each carries its id.
///
/// Threads  main.
/// RT       Not safe.
void log(const JournalLine& line);

void log(LogLevel level, const Phrase& phrase);

/// An error as a function returned it: with an id, or in a backend's own words.
void logError(const std::string& error);

/// The line as it is written, without its level.
[[nodiscard]] std::string withId(const JournalLine& line);

/// Whether @p file is the journal's stream, as $JOURNAL_STREAM names it: "DEVICE:INODE". Terminals
/// and other programs inherit the variable, so that its presence alone says nothing.
[[nodiscard]] bool isJournal(const char* journal_stream, const struct stat& file);

}  // namespace appliance
