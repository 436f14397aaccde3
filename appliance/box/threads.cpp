#include "appliance/box/threads.h"

#include <utility>

namespace appliance {

std::expected<void, std::string> Threads::startInto(
    rt::Thread& thread, const std::string& name, const ThreadSchedule& how,
    std::function<void(const std::stop_token&)> body) {
  auto started = rt::Thread::start(threadConfig(name, how), std::move(body));
  if (!started) {
    return std::unexpected(withId(phrase<Word::kThreadRefused>(name, started.error().where)));
  }
  if (!started->grant().complete()) {
    const Phrase plain = phrase<Word::kThreadPlain>(name);
    if (require_) return std::unexpected(withId(plain));
    remarks_.add("thread " + name, plain);
  }
  thread = std::move(*started);
  return {};
}

}  // namespace appliance
