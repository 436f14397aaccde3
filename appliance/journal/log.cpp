#include "appliance/journal/log.h"

#include <cstdio>
#include <cstdlib>

#include <systemd/sd-daemon.h>

namespace appliance {
namespace {

void write(const char* level, const char* word, std::string_view line) {
  static const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  std::fprintf(stderr, "%s%.*s\n", journal ? level : word, static_cast<int>(line.size()),
               line.data());
}

}  // namespace

void logInfo(std::string_view line) {
  write(SD_INFO, "", line);
}
void logWarning(std::string_view line) {
  write(SD_WARNING, "warning: ", line);
}
void logError(std::string_view line) {
  write(SD_ERR, "error: ", line);
}

}  // namespace appliance
