// The D-Bus interface as it is published: its XML files, and who may do what.

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/control_daemon.h"
#include "tests/support/interface_members.h"
#include "tests/support/output_of.h"
#include "tests/support/policed_bus.h"
#include "tests/support/private_bus.h"
#include "tests/support/temporary_folder.h"

namespace {

using test::contentOf;
using test::membersOf;
using test::outputOf;
using testing::HasSubstr;
using testing::Not;

/// A work that runs until it is cancelled.
class Endless : public appliance::JobWork {
 public:
  [[nodiscard]] appliance::JobReport report() const override { return {}; }
  void cancel() override {}
};

/// What the XML files say of the objects that are named @p node.
std::set<std::string> publishedFor(const std::string& node) {
  std::set<std::string> published;
  for (const auto& file : std::filesystem::directory_iterator(KAGAMI_CONTROL_FOLDER)) {
    if (file.path().extension() != ".xml") continue;
    const std::string text = contentOf(file.path());
    if (text.find(node) != std::string::npos) published.merge(membersOf(text));
  }
  return published;
}

TEST(ControlInterfaces, TheXmlFilesSayWhatTheRunningDaemonSays) {
  const test::PrivateBus bus;
  if (bus.address().empty()) GTEST_SKIP() << "dbus-daemon cannot be started here";
  test::Box box;
  appliance::JobRegistry jobs;
  ASSERT_TRUE(jobs.start({.kind = "check", .owner = "", .work = std::make_unique<Endless>()}));
  const test::Daemon daemon(bus.address(), box, jobs);
  ASSERT_TRUE(daemon.waitUntilConnected()) << daemon.trouble();
  const auto seen = [&bus](const std::string& path) {
    return membersOf(outputOf("busctl --address='" + bus.address() +
                              "' --xml-interface introspect org.kagami.Kagami1 " + path));
  };
  if (outputOf("busctl --version").find("systemd") == std::string::npos)
    GTEST_SKIP() << "busctl is not installed (package systemd)";
  EXPECT_EQ(publishedFor("<node name=\"/org/kagami/Kagami1\">"), seen("/org/kagami/Kagami1"));
  EXPECT_EQ(publishedFor("<node>"), seen("/org/kagami/Kagami1/jobs/1"));
}

using test::kAnybodyElse;
using test::kOperator;
using test::kViewer;

/// A system bus with the policy file that is installed.
class Policy : public testing::Test {
 protected:
  void SetUp() override {
    if (geteuid() != 0) GTEST_SKIP() << "another user's calls can be made by root only";
    bus_.emplace(test::policedBusOptions(folder_.path()));
    if (bus_->address().empty()) GTEST_SKIP() << "dbus-daemon cannot be started here";
    daemon_.emplace(bus_->address(), box_, jobs_);
    ASSERT_TRUE(daemon_->waitUntilConnected()) << daemon_->trouble();
    if (outputOf("setpriv --version").find("util-linux") == std::string::npos)
      GTEST_SKIP() << "setpriv is not installed (package util-linux)";
  }

  /// What `busctl` answers @p user.
  [[nodiscard]] std::string answerTo(const std::string& user, const std::string& call) const {
    return outputOf("setpriv --reuid=" + user + " --regid=" + user +
                    " --clear-groups busctl --address='" + bus_->address() +
                    "' call org.kagami.Kagami1 /org/kagami/Kagami1 " + call);
  }

  test::TemporaryFolder folder_;
  std::optional<test::PrivateBus> bus_;
  test::Box box_;
  appliance::JobRegistry jobs_;
  std::optional<test::Daemon> daemon_;
};

constexpr const char* kLook = "org.kagami.Kagami1 Status";
constexpr const char* kReadAll = "org.freedesktop.DBus.Properties GetAll s org.kagami.Kagami1";
constexpr const char* kOperate = "org.kagami.Kagami1.Control SetView u 3";
constexpr const char* kMaintain = "org.kagami.Kagami1.Maintenance ReleaseScreen";
constexpr const char* kSnapshot = "org.kagami.Kagami1.Depth Snapshot u 1";
constexpr const char* kDenied = "Access denied";

TEST_F(Policy, AnybodyElseGetsNothing) {
  for (const char* call : {kLook, kReadAll, kOperate, kMaintain, kSnapshot})
    EXPECT_THAT(answerTo(kAnybodyElse, call), HasSubstr(kDenied)) << call;
  EXPECT_TRUE(box_.commands().empty());
}

TEST_F(Policy, AViewerLooksAndDoesNothing) {
  EXPECT_THAT(answerTo(kViewer, kLook), HasSubstr("view_wanted"));
  EXPECT_THAT(answerTo(kViewer, kReadAll), HasSubstr("\"Mode\""));
  for (const char* call : {kOperate, kMaintain, kSnapshot})
    EXPECT_THAT(answerTo(kViewer, call), HasSubstr(kDenied)) << call;
  EXPECT_TRUE(box_.commands().empty());
}

TEST_F(Policy, AnOperatorLooksAndOperates) {
  EXPECT_THAT(answerTo(kOperator, kReadAll), HasSubstr("\"Mode\""));
  EXPECT_THAT(answerTo(kOperator, kOperate), Not(HasSubstr(kDenied)));
  EXPECT_EQ(box_.commands().size(), 1U);
  EXPECT_THAT(answerTo(kOperator, kMaintain), HasSubstr(kDenied));
  EXPECT_THAT(answerTo(kOperator, kSnapshot), HasSubstr(kDenied));
}

TEST_F(Policy, RootMaintains) {
  EXPECT_THAT(outputOf("busctl --address='" + bus_->address() +
                       "' call org.kagami.Kagami1 /org/kagami/Kagami1 " + kMaintain),
              Not(HasSubstr(kDenied)));
}

}  // namespace
