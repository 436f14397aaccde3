#include "tests/support/commanded_box.h"

#include <chrono>
#include <thread>
#include <utility>

#include "tests/support/policed_bus.h"

namespace test {
namespace {

using namespace std::chrono_literals;

/// Asks until the answer is right; otherwise reports the last one.
testing::AssertionResult comesTrue(const std::function<bool(std::string& answer)>& ask) {
  std::string last;
  for (int i = 0; i < 100; ++i) {
    if (ask(last)) return testing::AssertionSuccess();
    std::this_thread::sleep_for(100ms);
  }
  return testing::AssertionFailure() << last;
}

}  // namespace

CommandedBox::CommandedBox(CameraNetwork network, BusKind kind)
    : network_(std::move(network)),
      bus_(kind == BusKind::kPoliced ? policedBusOptions(folder_.path())
                                     : std::vector<std::string>{"--session"}),
      emulator_(emulatorCommand(network_, "448x320", folder_.path()), folder_ / "emulator.log") {}

void CommandedBox::SetUp() {
  if (bus_.address().empty()) GTEST_SKIP() << "dbus-daemon is not installed";
  ASSERT_TRUE(emulator_.waitForOutput("ready", 30s)) << emulator_.output();
}

void CommandedBox::TearDown() {
  if (!daemon_) return;
  daemon_->terminate();
  EXPECT_EQ(daemon_->wait(60s), 0) << daemon_->output();
}

void CommandedBox::startDaemon(const std::vector<std::string>& settings) {
  std::vector<std::string> all = settings;
  all.push_back("control.bus=" + bus_.address());
  daemon_ = std::make_unique<ChildProcess>(kagamidCommand(network_, folder_.path(), all),
                                           folder_ / "kagamid.log");
  ASSERT_TRUE(daemon_->waitForOutput("running:", 60s)) << daemon_->output();
}

CommandedBox::Answer CommandedBox::kagami(std::vector<std::string> words) {
  words.insert(words.begin(), {KAGAMI, "--bus", bus_.address()});
  ChildProcess program(words, folder_ / "kagami.log");
  const int exit_status = program.wait(20s).value_or(-1);
  return {exit_status, program.output()};
}

nlohmann::json CommandedBox::status() {
  const Answer answer = kagami({"status", "--json"});
  if (answer.exit_status != 0) return nlohmann::json::value_t::discarded;
  return nlohmann::json::parse(answer.text, nullptr, /*allow_exceptions=*/false);
}

testing::AssertionResult CommandedBox::says(const std::string& text) {
  return comesTrue([&](std::string& answer) {
    answer = kagami({"status"}).text;
    return answer.find(text) != std::string::npos;
  });
}

testing::AssertionResult CommandedBox::becomes(
    const std::function<bool(const nlohmann::json&)>& wanted) {
  return comesTrue([&](std::string& answer) {
    const nlohmann::json now = status();
    if (now.is_discarded()) return false;
    answer = now.dump();
    return wanted(now);
  });
}

}  // namespace test
