#pragma once

#include <array>
#include <chrono>
#include <expected>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/control/control_server.h"
#include "appliance/loop/event_loop.h"
#include "tests/support/becomes_true.h"

namespace test {

inline constexpr const char* kName = "org.kagami.Kagami1";

/// The daemon's side of both interfaces: keeps what came, answers with a fixed status.
class Box : public appliance::ControlSink, public appliance::StatusSource {
 public:
  std::optional<appliance::CommandId> command(const appliance::Command& command) override {
    const std::scoped_lock lock(mutex_);
    if (full_) return std::nullopt;
    commands_.push_back(command);
    if (outcome_) answers_.push_back({.id = commands_.size(), .outcome = *outcome_});
    return commands_.size();
  }
  std::optional<appliance::CommandAnswer> nextAnswer() override {
    const std::scoped_lock lock(mutex_);
    if (answers_.empty()) return std::nullopt;
    const appliance::CommandAnswer answer = answers_.back();
    answers_.pop_back();
    return answer;
  }
  [[nodiscard]] int answersFd() const override { return -1; }  // asked at each tick
  [[nodiscard]] std::string metrics() const override { return R"({"trigger.missed":0})"; }
  bool setTarget(const std::array<double, 3>& target_m) override {
    const std::scoped_lock lock(mutex_);
    target_m_ = target_m;
    return true;
  }
  void releaseTarget() override {
    const std::scoped_lock lock(mutex_);
    target_m_ = {0, 0, 1};
  }
  /// Takes a text that begins with "format" and ignores its second line.
  [[nodiscard]] std::expected<std::vector<std::string>, appliance::Phrase> loadRig(
      const std::string& text, const std::string& name) override {
    const std::scoped_lock lock(mutex_);
    if (!text.starts_with("format"))
      return std::unexpected(appliance::phrase<appliance::Word::kRigRefused>(name + ":1: no rig"));
    rig_text_ = text;
    return std::vector<std::string>{name + ":2: ignored"};
  }
  [[nodiscard]] std::string rigText() const {
    const std::scoped_lock lock(mutex_);
    return rig_text_;
  }
  void setScreenReleased(bool released) override {
    const std::scoped_lock lock(mutex_);
    screen_ = released ? hal::ScreenState::kReleased : hal::ScreenState::kShowing;
  }
  [[nodiscard]] appliance::Status status() const override {
    const std::scoped_lock lock(mutex_);
    appliance::Status status;
    status.mode = appliance::Mode::kDelayed;
    status.view_wanted = 6;
    status.view_shown = 7;
    status.delay_ms = 1500;
    status.history_ms = 7500;
    status.target_m = target_m_;
    status.shown_hz = 39.5;
    status.screen = screen_;
    status.frames_lost = 3;
    for (int i = 1; i <= 20; ++i)
      status.cameras.push_back(
          {.name = "cam" + std::to_string(i), .state = appliance::CameraState::kStreaming});
    status.cameras[6].state = appliance::CameraState::kLost;
    status.cameras[6].reason = "no frames since 0.4 s: check its cable";
    status.cameras[6].frames_lost = 3;
    status.degraded = degraded_;
    return status;
  }
  void degrade(const std::string& line) {
    const std::scoped_lock lock(mutex_);
    degraded_.push_back({.key = "sensor", .text = line});
  }
  /// What becomes of the commands from now on; none: they are not answered.
  void answerWith(std::optional<appliance::CommandOutcome> outcome) {
    const std::scoped_lock lock(mutex_);
    outcome_ = outcome;
  }
  void fill() {
    const std::scoped_lock lock(mutex_);
    full_ = true;
  }
  [[nodiscard]] std::vector<appliance::Command> commands() const {
    const std::scoped_lock lock(mutex_);
    return commands_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<appliance::Command> commands_;
  std::array<double, 3> target_m_{0, 0, 1};
  std::string rig_text_;
  std::vector<appliance::Remark> degraded_{{"memory", "memory is not locked"},
                                           {"camera 7", "view 7 \"rear\" is lost"}};
  std::vector<appliance::CommandAnswer> answers_;
  std::optional<appliance::CommandOutcome> outcome_ = appliance::CommandOutcome::kApplied;
  bool full_ = false;
  hal::ScreenState screen_ = hal::ScreenState::kShowing;
};

/// The event loop of a daemon that serves @p box, on a thread of its own; a tick each 10 ms.
class Daemon {
 public:
  Daemon(const std::string& bus, Box& box, appliance::JobRegistry& jobs)
      : thread_([this, bus, &box, &jobs](const std::stop_token& stop) {
          const auto loop = appliance::EventLoop::create();
          ASSERT_TRUE(loop.has_value()) << loop.error();
          appliance::ControlServer server(**loop, {.bus = bus, .name = kName}, box, box, jobs);
          ASSERT_TRUE((*loop)->every(std::chrono::milliseconds(10), [&] {
            server.collectAnswers();
            server.tick(rt::now(), box.status());
            const std::scoped_lock lock(mutex_);
            trouble_ = server.trouble();
            connected_ = server.connected();
            if (stop.stop_requested()) (*loop)->requestStop();
          }));
          const auto ended = (*loop)->run();
          EXPECT_TRUE(ended.has_value()) << ended.error();
        }) {}

  [[nodiscard]] std::string trouble() const {
    const std::scoped_lock lock(mutex_);
    return trouble_;
  }
  [[nodiscard]] bool connected() const {
    const std::scoped_lock lock(mutex_);
    return connected_;
  }
  [[nodiscard]] bool waitUntilConnected() const {
    return becomesTrue([this] { return connected(); });
  }
  [[nodiscard]] bool waitForTrouble() const {
    return becomesTrue([this] { return !trouble().empty(); });
  }

 private:
  mutable std::mutex mutex_;
  std::string trouble_;
  bool connected_ = false;
  std::jthread thread_;
};

}  // namespace test
