#include "appliance/box/box.h"

#include <utility>

#include "appliance/box/memory.h"
#include "appliance/box/run_facts.h"

namespace appliance {

Box::Box(const Site& site, const BoxParts& parts)
    : site_(site),
      on_hang_(parts.on_hang),
      threads_(site.config.realtime.require, remarks_),
      rigs_(site.rig),
      board_(static_cast<std::uint32_t>(site.rig.cameras.size())),
      commands_(board_.wake_render),
      control_commands_(commands_.open("control")),
      parts_(parts.patience) {
  for (const Phrase& phrase : site.degraded) remarks_.add("site", phrase);
}

Box::~Box() {
  endWithout(parts_.stop());
}

std::expected<std::unique_ptr<Box>, std::string> Box::start(const Site& site,
                                                            const BoxParts& parts) {
  std::unique_ptr<Box> box(new Box(site, parts));
  auto done = box->makeShared(parts);
  if (done) done = box->makeParts(parts.parts);
  if (done) done = box->run();
  if (done) return box;
  if (box->parts_.hung()) box->endWithout({done.error()});
  return std::unexpected(done.error());
}

std::expected<void, std::string> Box::makeShared(const BoxParts& parts) {
  const Config& config = site_.config;
  std::uint32_t pins = 0;
  for (const PartEntry& part : parts.parts) pins += part.pins_per_camera;
  const HistoryUse use{.pins_per_camera = pins, .shared = parts.display.uploadReason().empty()};
  auto history = makeHistory(config, site_.rig, use, remarks_);
  if (!history) return std::unexpected(history.error());
  history_ = std::move(*history);
  if (auto locked = lockMemory(config.realtime, *history_, remarks_); !locked) return locked;
  if (!config.state.trace.empty()) {
    auto trace = TraceWriter::open(config.state.trace);
    if (!trace) return std::unexpected(trace.error());
    trace_ = std::move(*trace);
  }
  shared_ = std::make_unique<const Shared>(Shared{.metrics = metrics_,
                                                  .jobs = jobs_,
                                                  .config = config,
                                                  .rig = site_.rig,
                                                  .rigs = rigs_,
                                                  .history = *history_,
                                                  .board = board_,
                                                  .target = target_,
                                                  .depth = depth_,
                                                  .overlay = overlay_,
                                                  .commands = commands_,
                                                  .shown = shown_,
                                                  .display = parts.display,
                                                  .observer = parts.observer,
                                                  .trace = trace_.get(),
                                                  .threads = threads_,
                                                  .remarks = remarks_});
  return {};
}

std::expected<void, std::string> Box::makeParts(std::span<const PartEntry> parts) {
  for (const PartEntry& entry : parts) {
    auto part = entry.make(*shared_);
    if (!part) return std::unexpected(part.error());
    if (*part) parts_.add(std::move(*part));
  }
  return {};
}

void Box::countLosses() {
  if (trace_) {
    trace_metrics_ = metrics_.group("trace");
    trace_metrics_.addCount("dropped", [this] { return trace_->dropped(); });
  }
  command_metrics_ = metrics_.group("commands");
  for (const auto& sender : commands_.senders())
    command_metrics_.addCount(sender->name() + "_refused",
                              [one = sender.get()] { return one->refused(); });
}

std::expected<void, std::string> Box::run() {
  countLosses();
  if (auto started = parts_.start(); !started) return started;
  if (trace_) trace_->begin(runRecord(*shared_, status()));
  return {};
}

std::expected<void, std::string> Box::stop() {
  if (std::exchange(stopped_, true)) return {};
  const std::vector<std::string> hung = parts_.stop();
  std::expected<void, std::string> done;
  if (trace_) done = trace_->finish(summaryRecord(status()));
  endWithout(hung);
  return hung.empty() ? done : std::unexpected(hung.front());
}

void Box::endWithout(const std::vector<std::string>& hung) {
  if (!hung.empty() && on_hang_) on_hang_(hung);
}

std::vector<BusObject> Box::busObjects() const {
  std::vector<BusObject> objects;
  parts_.addBusObjects(objects);
  return objects;
}

Status Box::status() const {
  Status status{.degraded = remarks_.list()};
  parts_.report(status);
  addBoxSections(status, commands_);
  remarkTrace(status, trace_.get());
  return status;
}

}  // namespace appliance
