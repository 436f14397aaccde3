#include "appliance/service/box_service.h"

#include <algorithm>
#include <utility>

#include <systemd/sd-daemon.h>

#include "appliance/journal/log.h"
#include "appliance/words/phrase.h"
#include "rt/printable.h"

namespace appliance {

std::expected<std::unique_ptr<BoxService>, std::string> BoxService::start(
    EventLoop& loop, const ControlServer::Place& place, ControlSink& sink,
    const StatusSource& source, JobRegistry& jobs, std::span<const BusObject> objects) {
  std::unique_ptr<BoxService> service(new BoxService(loop, source));
  if (place.bus != "none")
    service->control_ = std::make_unique<ControlServer>(loop, place, sink, source, jobs);
  if (service->control_)
    for (const BusObject& object : objects) service->control_->show(object);
  BoxService& serving = *service;
  auto added = loop.every(kTick, [&serving] { serving.tick(); });
  if (added) added = loop.every(kWatchdog, [] { (void)sd_notify(0, "WATCHDOG=1"); });
  if (added && service->control_)
    added = loop.watch(sink.answersFd(), [&serving] { serving.tick(); });
  if (!added) return std::unexpected(added.error());
  serving.tick();
  if (serving.control_) serving.waitForName();
  return service;
}

/// A client that waits for READY=1 finds the name.
void BoxService::waitForName() {
  const rt::Timestamp end = rt::now() + kWaitForName;
  while (!control_->connected() && control_->trouble().empty() && rt::now() < end) {
    if (!loop_.turn()) return;  // run() says why
  }
}

std::expected<void, std::string> BoxService::run() {
  (void)sd_notify(0, "READY=1");
  const auto ended = loop_.run();
  (void)sd_notify(0, "STOPPING=1");
  return ended;
}

void BoxService::tick() {
  const rt::Timestamp now = rt::now();
  if (control_) control_->collectAnswers();
  Status status = source_.status();
  std::vector<Condition> more;
  if (control_) more.push_back(controlCondition());
  for (const JournalLine& line : journal_.look(now, status, more)) log(line);
  std::string text = serviceText(status);
  if (text != service_text_) {
    (void)sd_notify(0, ("STATUS=" + text).c_str());
    service_text_ = std::move(text);
  }
  if (control_) control_->tick(now, std::move(status));
}

Condition BoxService::controlCondition() const {
  const std::string trouble = control_->trouble();
  const auto now = !trouble.empty()        ? Condition::Now::kHolds
                   : control_->connected() ? Condition::Now::kOver
                                           : Condition::Now::kUnclear;
  return {.key = "control",
          .kind = trouble,
          .now = now,
          .text = trouble,
          .end = textOf(phrase<Word::kControlServes>(control_->title())),
          .word = Word::kControlMissing,
          .end_word = Word::kControlServes};
}

std::string serviceText(const Status& status) {
  const auto in_trouble = std::ranges::count_if(status.cameras, [](const CameraStatus& camera) {
    return camera.trouble != CameraTrouble::kNone;
  });
  std::string text = textOf(phrase<Word::kServiceView>(nameOf(status.mode), status.view_wanted + 1,
                                                       status.cameras.size()));
  if (in_trouble > 0) text += "; " + textOf(phrase<Word::kServiceTroubles>(in_trouble));
  if (status.screen != hal::ScreenState::kShowing)
    text += "; " + textOf(phrase<Word::kScreenState>(nameOf(status.screen)));
  if (!status.degraded.empty())
    text += "; " + textOf(phrase<Word::kServiceDegraded>(status.degraded.size()));
  return rt::printable(text);
}

}  // namespace appliance
