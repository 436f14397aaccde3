#include "tests/unit/sample_part/sample_part.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "appliance/box/shared.h"
#include "rt/periodic_loop.h"

namespace appliance {
namespace {

class SamplePart final : public Part {
 public:
  SamplePart(const Shared& shared, const SampleSettings& settings)
      : shared_(shared), settings_(settings) {}

  [[nodiscard]] std::string_view name() const override { return "sample"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    auto thread = shared_.threads.start("sample", {}, [this](const auto& stop) { run(stop); });
    if (!thread) return std::unexpected(thread.error());
    thread_ = std::move(*thread);
    return {};
  }

  void stop() override { thread_ = {}; }

  void report(Status& status) const override {
    const std::int64_t turns = turns_.load();
    status.sections.push_back({.key = "sample",
                               .line = turns > 0 ? "counting" : "waiting",
                               .values = {{"turns", turns}}});
    if (turns == 0) status.degraded.push_back({"sample", "sample: it has not counted yet"});
  }

  [[nodiscard]] Answer handle(const Request& request) override {
    if (request.verb != "sample.reset") return std::nullopt;
    turns_ = 0;
    return std::expected<void, std::string>{};
  }

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

}  // namespace

MadePart makeSamplePart(const Shared& shared, const SampleSettings& settings) {
  if (!settings.enabled) return nullptr;
  return std::make_unique<SamplePart>(shared, settings);
}

}  // namespace appliance
