// A program that asks the daemon for all its properties without a pause, and never looks at an
// answer, until SIGTERM: `bus_flooder BUS [USER]`. Root runs it as USER, with that user's own group
// and no other. It says how its first call was answered, and at the end how often it asked.

#include <csignal>
#include <cstdint>
#include <cstdio>

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include "appliance/control/bus.h"

namespace {

volatile std::sig_atomic_t ended = 0;

bool becomeUser(const char* name) {
  const passwd* user = getpwnam(name);
  return user != nullptr && setgroups(0, nullptr) == 0 &&
         setresgid(user->pw_gid, user->pw_gid, user->pw_gid) == 0 &&
         setresuid(user->pw_uid, user->pw_uid, user->pw_uid) == 0;
}

/// As every call of the flood, but with an answer.
void sayTheFirstAnswer(sd_bus* bus) {
  sd_bus_error error = SD_BUS_ERROR_NULL;
  const int answered = sd_bus_call_method(bus, "org.kagami.Kagami1", "/org/kagami/Kagami1",
                                          "org.freedesktop.DBus.Properties", "GetAll", &error,
                                          nullptr, "s", "org.kagami.Kagami1");
  std::printf("first call: %s\n", answered >= 0 ? "answered" : error.name);
  std::fflush(stdout);
  sd_bus_error_free(&error);
}

bool ask(sd_bus* bus) {
  sd_bus_message* call = nullptr;
  if (sd_bus_message_new_method_call(bus, &call, "org.kagami.Kagami1", "/org/kagami/Kagami1",
                                     "org.freedesktop.DBus.Properties", "GetAll") < 0)
    return false;
  sd_bus_message_append(call, "s", "org.kagami.Kagami1");
  sd_bus_message_set_expect_reply(call, 0);
  const bool sent = sd_bus_send(bus, call, nullptr) >= 0;
  sd_bus_message_unref(call);
  (void)sd_bus_flush(bus);
  return sent;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3 || (argc == 3 && !becomeUser(argv[2]))) {
    std::fputs("usage, USER by root only: bus_flooder BUS [USER]\n", stderr);
    return 2;
  }
  const auto bus = appliance::openBus(argv[1]);
  if (!bus) {
    std::fprintf(stderr, "%s\n", bus.error().c_str());
    return 1;
  }
  std::signal(SIGTERM, [](int) { ended = 1; });
  sayTheFirstAnswer(bus->get());
  constexpr std::uint64_t kReadEvery = 64;  // what came meanwhile: nothing, or refusals
  std::uint64_t calls = 0;
  while (ended == 0) {
    if (ask(bus->get())) ++calls;
    if (calls % kReadEvery == 0)
      while (sd_bus_process(bus->get(), nullptr) > 0) {
      }
  }
  std::printf("calls: %llu\n", static_cast<unsigned long long>(calls));
  return 0;
}
