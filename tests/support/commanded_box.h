#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/private_bus.h"
#include "tests/support/temporary_folder.h"

namespace test {

/// Who may call the daemon of a test.
enum class BusKind : std::uint8_t {
  kOwnUser,  ///< a session bus: the user of the test, with every right
  kPoliced,  ///< a system bus with the policy file that is installed; for tests run by root
};

/// The whole box for tests that speak with it: emulated cameras, kagamid on them, and the kagami
/// command on a bus of their own. Skips where there is no dbus-daemon.
class CommandedBox : public testing::Test {
 protected:
  explicit CommandedBox(CameraNetwork network, BusKind kind = BusKind::kOwnUser);

  void SetUp() override;
  /// The daemon ends well, whatever the test did with it.
  void TearDown() override;

  /// kagamid with @p settings, until it runs.
  void startDaemon(const std::vector<std::string>& settings = {});

  [[nodiscard]] const TemporaryFolder& folder() const { return folder_; }
  [[nodiscard]] const std::string& busAddress() const { return bus_.address(); }
  [[nodiscard]] ChildProcess& daemon() { return *daemon_; }

  struct Answer {
    int exit_status = -1;
    std::string text;
  };
  [[nodiscard]] Answer kagami(std::vector<std::string> words);
  /// Of `kagami status --json`; discarded() where there is no answer.
  [[nodiscard]] nlohmann::json status();

  /// Whether `kagami status` comes to say @p text, within a generous time.
  [[nodiscard]] testing::AssertionResult says(const std::string& text);
  /// Whether the daemon comes to be as @p wanted says, within a generous time.
  [[nodiscard]] testing::AssertionResult becomes(
      const std::function<bool(const nlohmann::json&)>& wanted);

 private:
  CameraNetwork network_;
  TemporaryFolder folder_;
  PrivateBus bus_;
  ChildProcess emulator_;
  std::unique_ptr<ChildProcess> daemon_;
};

}  // namespace test
