// What a maintainer types: kagami speaks over a bus with the running kagamid, which shows what
// emulated cameras send.

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/commanded_box.h"

namespace {

using nlohmann::json;

class CommandLine : public test::CommandedBox {
 protected:
  CommandLine() : CommandedBox({.first_address = "127.0.5.1", .cameras = 2, .wire_port = 3995}) {}

  void SetUp() override {
    CommandedBox::SetUp();
    if (!IsSkipped() && !HasFatalFailure()) startDaemon();
  }
};

TEST_F(CommandLine, LeadsTheBoxThroughItsModes) {
  ASSERT_TRUE(becomes([](const json& status) {
    return status["mode"] == "live" && status["shown_hz"] > 0 && status["history_ms"] > 1500;
  }));
  EXPECT_EQ(kagami({"delay", "1"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) {
    return status["mode"] == "delayed" && status["delay_ms"] == 1000;
  }));
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(kagami({"freeze"}).exit_status, 0);
    EXPECT_EQ(status()["mode"], "frozen") << "an answer comes after the effect, each time";
  }
  EXPECT_EQ(kagami({"thaw"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) { return status["mode"] == "delayed"; }));
  EXPECT_EQ(kagami({"freeze"}).exit_status, 0);
  EXPECT_EQ(kagami({"view", "2"}).exit_status, 0);
  EXPECT_TRUE(becomes(
      [](const json& status) { return status["mode"] == "frozen" && status["view_shown"] == 2; }));
  EXPECT_EQ(kagami({"target", "0.1", "0.2", "1.1"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) {
    return status["target_m"] == json::array({0.1, 0.2, 1.1}) &&
           status["target_origin"] == "set by hand";
  }));
  EXPECT_EQ(kagami({"target", "--release"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) { return status["target_origin"] == "the rig's"; }));
  EXPECT_NE(kagami({"target"}).exit_status, 0);
  EXPECT_EQ(kagami({"mode", "live"}).exit_status, 0);
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"speed", "1/2"},
                                             {"replay", "0.5", "1/4"},
                                             {"compare", "side-by-side", "--view", "2"},
                                             {"compare", "single"},
                                             {"mode", "live"}})
    EXPECT_EQ(kagami(words).exit_status, 0) << words.front();
  EXPECT_TRUE(becomes([](const json& status) { return status["mode"] == "live"; }));
}

TEST_F(CommandLine, RefusesWhatIsNotThereInOneLineAndStaysAsItWas) {
  ASSERT_TRUE(becomes([](const json& status) { return status["shown_hz"] > 0; }));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"view", "3"}, {"delay", "-1"}, {"mode", "backwards"}, {"speed", "2"}}) {
    const Answer answer = kagami(words);
    EXPECT_NE(answer.exit_status, 0) << words.front();
    EXPECT_FALSE(answer.text.empty()) << words.front();
  }
  EXPECT_TRUE(becomes(
      [](const json& status) { return status["mode"] == "live" && status["view_wanted"] == 1; }));
}

TEST_F(CommandLine, RefusesAFileThatIsNoRigOfThisBoxInOneLineAndReadsANewerFormat) {
  ASSERT_TRUE(becomes([](const json& status) { return status["shown_hz"] > 0; }));
  std::stringstream rig;
  rig << std::ifstream(folder() / "rig.toml").rdbuf();
  const std::string text = rig.str();
  const std::string body = text.substr(text.find('\n'));  // without its line "format = N"
  struct Case {
    std::string name, text, says;
  };
  for (const Case& bad :
       std::vector<Case>{{"binary", "\xff\xfe\x01 = 1", "binary:1: not valid TOML"},
                         {"empty", "", "the key \"format\" is missing"},
                         {"word", "format = \"two\"" + body, "format must be a whole number"},
                         {"other", "format = 1\n" + body.substr(0, body.rfind("[[camera]]")),
                          "this rig has 1 cameras, 2 are running"}}) {
    std::ofstream(folder() / bad.name) << bad.text;
    const Answer answer = kagami({"rig", "load", folder() / bad.name});
    EXPECT_NE(answer.exit_status, 0) << bad.name;
    EXPECT_NE(answer.text.find(bad.says), std::string::npos) << answer.text;
    EXPECT_EQ(std::ranges::count(answer.text, '\n'), 1) << answer.text;
  }
  for (const std::string place : {"/dev/zero", "/tmp", "/nonexistent"})
    EXPECT_NE(kagami({"rig", "load", place}).exit_status, 0) << place;

  std::ofstream(folder() / "newer") << "format = 3\nbeyond = 1" + body;
  const Answer newer = kagami({"rig", "load", folder() / "newer"});
  EXPECT_EQ(newer.exit_status, 0) << newer.text;
  EXPECT_NE(newer.text.find("format 3 is newer"), std::string::npos) << newer.text;
  EXPECT_NE(newer.text.find("unknown key \"beyond\""), std::string::npos) << newer.text;
  EXPECT_TRUE(becomes([](const json& status) { return status["shown_hz"] > 0; }));
}

TEST_F(CommandLine, TellsTheStateInWordsToo) {
  const Answer answer = kagami({"status"});
  EXPECT_EQ(answer.exit_status, 0);
  EXPECT_NE(answer.text.find("live"), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("view     1 of 2"), std::string::npos) << answer.text;
}

}  // namespace
