#include "appliance/box/threads.h"

#include <utility>

namespace appliance {

std::expected<void, std::string> Threads::startInto(
    rt::Thread& thread, const std::string& name, const ThreadSchedule& how,
    std::function<void(const std::stop_token&)> body) {
  auto started = rt::Thread::start(threadConfig(name, how), std::move(body));
  if (!started) {
    return std::unexpected("thread " + name + " does not start: " + started.error().where +
                           ": check [realtime] in the configuration");
  }
  if (!started->grant().complete()) {
    const Phrase plain = phrase<Word::kThreadPlain>(name);
    if (require_) return std::unexpected(textOf(plain));
    remarks_.add("thread " + name, plain);
  }
  thread = std::move(*started);
  return {};
}

}  // namespace appliance
