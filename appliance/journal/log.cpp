#include "appliance/journal/log.h"

#include <array>
#include <cstdio>
#include <cstdlib>

#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace appliance {
namespace {

struct Prefix {
  const char* level;
  const char* word;
};

/// In the order of LogLevel.
constexpr std::array<Prefix, 4> kPrefixes = {{
    {SD_ERR, "error: "},
    {SD_WARNING, "warning: "},
    {SD_NOTICE, ""},
    {SD_INFO, ""},
}};

bool journalReads() {
  struct stat file{};
  return fstat(STDERR_FILENO, &file) == 0 && isJournal(std::getenv("JOURNAL_STREAM"), file);
}

void write(LogLevel level, const std::string& line) {
  static const bool journal = journalReads();
  const Prefix& prefix = kPrefixes[static_cast<std::size_t>(level)];
  std::fprintf(stderr, "%s%s\n", journal ? prefix.level : prefix.word, line.c_str());
}

}  // namespace

std::string withId(const JournalLine& line) {
  return withId(line.word, line.text);
}

void log(const JournalLine& line) {
  write(line.level, withId(line));
}

void log(LogLevel level, const Phrase& phrase) {
  write(level, withId(phrase));
}

void logError(const std::string& error) {
  write(LogLevel::kError, withId(Word::kFailed, error));
}

bool isJournal(const char* journal_stream, const struct stat& file) {
  return journal_stream != nullptr &&
         journal_stream == std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
}

}  // namespace appliance
