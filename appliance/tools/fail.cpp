#include <cstdio>

#include "appliance/tools/commands.h"

void appliance::fail(const std::string& why) {
  std::fprintf(stderr, "kagami: %s\n", why.c_str());
  throw CommandFailed();
}
