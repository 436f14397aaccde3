#include "tests/kernel/support/whole_box.h"

#include <chrono>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "hal/button_panel.h"

namespace test {
namespace {

using namespace std::chrono_literals;

std::vector<std::string> lineNames(const char* trigger, const char* loop_back) {
  std::vector<std::string> names = {trigger, loop_back, ""};
  for (const hal::ButtonRow& row : hal::kButtons)
    names.push_back("button-" + std::string(row.name));
  for (const hal::LampRow& row : hal::kLamps) names.push_back("lamp-" + std::string(row.name));
  return names;
}

/// Until @p done, a quarter of a minute at most.
template <class Done>
bool waitUntil(Done&& done) {
  const auto end = std::chrono::steady_clock::now() + 15s;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

}  // namespace

WholeBox::WholeBox(std::string folder)
    : folder_(std::move(folder)), chip_("box", lineNames(kTriggerLine, kLoopBackLine)) {
  for (const hal::ButtonRow& row : hal::kButtons)
    chip_.pull("button-" + std::string(row.name), true);  // let go

  emulator_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{KAGAMI_EMULATOR, "--cameras", std::to_string(kCameras), "--size",
                               std::to_string(kWidthPx) + "x" + std::to_string(kHeightPx),
                               "--rig-out", path("rig.toml"), "--wire-log", path("wire.csv"),
                               "--stats", path("stats.json")},
      path("emulator.log"));
  bridge_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{TRIGGER_BRIDGE, kTriggerLine, "3990", "--loop-back",
                               chip_.lineFolder(kLoopBackLine)},
      path("bridge.log"));
  for (ChildProcess* program : {emulator_.get(), bridge_.get()}) {
    if (!program->waitForOutput("ready", 60s)) {
      ADD_FAILURE() << program->output();
      return;
    }
  }

  std::vector<std::string> command{KAGAMID, "--config", KAGAMID_CONFIG};
  for (const std::string& setting :
       {"rig.file=" + path("rig.toml"),
        std::string(R"(cameras.addresses=["127.0.0.1","127.0.0.2","127.0.0.3","127.0.0.4"])"),
        std::string("trigger.backend=gpiod"),
        std::string("trigger.lines=[\"") + kTriggerLine + "\"]",
        std::string("trigger.loopback_line=") + kLoopBackLine,
        std::string("trigger.rate_hz=15"),  // a quarter of the screen's
        std::string("history.sets=60"), std::string("display.backend=kms"),
        std::string("display.zoom=1"), std::string("display.mode=640x480"),
        std::string("director.sweep_views_per_s=2"), std::string("panel.backend=gpiod"),
        "state.trace=" + path("trace.jsonl"), std::string("control.bus=none")}) {
    command.insert(command.end(), {"--set", setting});
  }
  daemon_ = std::make_unique<ChildProcess>(command, path("kagamid.log"));
  running_ = daemon_->waitForOutput("running:", 120s);
  if (!running_) ADD_FAILURE() << daemon_->output();
}

void WholeBox::tap(const std::string& button) {
  chip_.pull("button-" + button, false);
  std::this_thread::sleep_for(80ms);
  chip_.pull("button-" + button, true);
}

bool WholeBox::waitForMode(const std::string& mode) {
  return waitUntil([&] {
    std::ifstream trace(path("trace.jsonl"));
    std::string last;
    for (std::string line; std::getline(trace, line) && !trace.eof();) {
      if (line.find(R"("record":"picture")") != std::string::npos) last = line;
    }
    return !last.empty() && nlohmann::json::parse(last)["mode"] == mode;
  });
}

bool WholeBox::waitForLamp(const std::string& mode, bool lit) const {
  return waitUntil([&] { return chip_.level("lamp-" + mode) == lit; });
}

void WholeBox::stop() {
  daemon_->terminate();
  daemon_exit = daemon_->wait(60s);
  daemon_output = daemon_->output();
  bridge_->terminate();
  (void)bridge_->wait(20s);
  emulator_->terminate();
  emulator_exit = emulator_->wait(20s);
}

}  // namespace test
