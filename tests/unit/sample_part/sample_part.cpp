#include "tests/unit/sample_part/sample_part.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "appliance/box/shared.h"
#include "appliance/control/bus_callbacks.h"
#include "appliance/control/bus_object.h"
#include "appliance/jobs/job_thread.h"
#include "rt/periodic_loop.h"

namespace appliance {
namespace {

class SamplePart final : public Part {
 public:
  SamplePart(const Shared& shared, const SampleSettings& settings)
      : shared_(shared), settings_(settings) {}

  [[nodiscard]] std::string_view name() const override { return "sample"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    return shared_.threads.startInto(thread_, "sample", {},
                                     [this](const auto& stop) { run(stop); });
  }

  void stop() override { thread_ = {}; }

  void report(Status& status) const override {
    const std::int64_t turns = turns_.load();
    status.sections.push_back({.key = "sample",
                               .line = turns > 0 ? "counting" : "waiting",
                               .values = {{"turns", turns}}});
    if (turns == 0) status.degraded.push_back({"sample", "sample: it has not counted yet"});
  }

  void addBusObjects(std::vector<BusObject>& objects) override;

  [[nodiscard]] Answer handle(const Request& request) override {
    if (request.verb != "sample.reset") return std::nullopt;
    reset();
    return std::expected<void, std::string>{};
  }

  void reset() { turns_ = 0; }
  /// The job ends when the part has counted this many more.
  [[nodiscard]] std::expected<JobId, Phrase> count(std::uint32_t turns);
  [[nodiscard]] std::int64_t turns() const { return turns_.load(); }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      ++turns_;
      rt::sleepUntil(rt::now() + settings_.period);
    }
  }

  const Shared& shared_;
  const SampleSettings settings_;
  std::atomic<std::int64_t> turns_{0};
  rt::Thread thread_;
};

std::expected<JobId, Phrase> SamplePart::count(std::uint32_t turns) {
  auto work = JobThread::start([this, turns, begin = turns_.load()](JobThread::Progress& progress,
                                                                    const std::stop_token& stop) {
    for (std::int64_t done = 0; done < turns && !stop.stop_requested();) {
      rt::sleepUntil(rt::now() + settings_.period);
      done = turns_.load() - begin;
      progress.set(static_cast<double>(done) / turns);
    }
    return JobThread::Result(std::to_string(turns) + " turns");
  });
  if (!work) return std::unexpected(work.error());
  return shared_.jobs.start({.kind = "sample-count", .owner = "", .work = std::move(*work)});
}

int getTurns(SamplePart& part, const char* /*property*/, sd_bus_message* reply) {
  return sd_bus_message_append(reply, "x", part.turns());
}

int callReset(SamplePart& part, sd_bus_message* message, sd_bus_error* /*error*/) {
  part.reset();
  return sd_bus_reply_method_return(message, "");
}

int callCount(SamplePart& part, sd_bus_message* message, sd_bus_error* error) {
  std::uint32_t turns = 0;
  if (const int r = sd_bus_message_read(message, "u", &turns); r < 0) return r;
  const auto job = part.count(turns);
  if (!job) return refuse(error, job.error());
  return sd_bus_reply_method_return(message, "o", jobPath(*job).c_str());
}

const auto kTable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_PROPERTY("Turns", "x", (onProperty<SamplePart, getTurns>), 0, 0),
    SD_BUS_METHOD("Reset", "", "", (onMethod<SamplePart, callReset>), SD_BUS_VTABLE_UNPRIVILEGED),
    SD_BUS_METHOD("Count", "u", "o", (onMethod<SamplePart, callCount>), SD_BUS_VTABLE_UNPRIVILEGED),
    SD_BUS_VTABLE_END,
});

void SamplePart::addBusObjects(std::vector<BusObject>& objects) {
  objects.push_back({.path = "/org/kagami/Kagami1/sample",
                     .interface = "org.kagami.Kagami1.Sample",
                     .vtable = kTable.data(),
                     .target = this});
}

}  // namespace

MadePart makeSamplePart(const Shared& shared, const SampleSettings& settings) {
  if (!settings.enabled) return nullptr;
  return std::make_unique<SamplePart>(shared, settings);
}

}  // namespace appliance
