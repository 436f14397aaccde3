#include "appliance/config/config.h"

#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::Config;
using appliance::loadConfig;
using appliance::parseConfig;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kInstalledFile =
    std::string(KAGAMI_SOURCE_DIR) + "/appliance/config/kagamid.toml";

std::string faultOf(std::string_view text, const std::vector<std::string>& overrides = {}) {
  const auto config = parseConfig(text, "kagamid.toml", overrides);
  return config ? "no fault" : config.error();
}

/// The keys that stand in the installed file, read from its text alone.
std::set<std::string> keysInFile() {
  std::ifstream in(kInstalledFile);
  std::set<std::string> keys;
  std::string section;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[')
      section = line.substr(1, line.find(']') - 1);
    else
      keys.insert(section + "." + line.substr(0, line.find(' ')));
  }
  return keys;
}

TEST(Config, TheInstalledFileHoldsTheDefaultsOfTheStruct) {
  const auto config = loadConfig(kInstalledFile);
  ASSERT_TRUE(config.has_value()) << config.error();
  EXPECT_TRUE(*config == Config{});
}

TEST(Config, TheInstalledFileShowsEveryKey) {
  const auto keys = appliance::configKeys();
  EXPECT_EQ(keysInFile(), std::set<std::string>(keys.begin(), keys.end()));
  EXPECT_GE(keys.size(), 50u);
}

TEST(Config, EveryKeyIsReadIntoTheStruct) {
  // Each key in turn with another value must make another configuration.
  const std::vector<std::string> other = {"rig.file=/x",
                                          "cameras.backend=x",
                                          "cameras.addresses=[\"10.0.0.1\"]",
                                          "cameras.trigger_source=Line2",
                                          "cameras.pixel_format=Mono8",
                                          "cameras.exposure_us=900",
                                          "cameras.gain_db=1",
                                          "cameras.white_balance_rgb=[1,1,2]",
                                          "cameras.packet_size_bytes=1500",
                                          "cameras.packet_delay_ns=1",
                                          "cameras.socket_buffer_bytes=1000000",
                                          "cameras.opto_delay_us=[0,30]",
                                          "network.uplinks=1",
                                          "network.uplink_gbps=25",
                                          "network.camera_link_gbps=2.5",
                                          "resend.enabled=false",
                                          "resend.packet_timeout_us=4000",
                                          "resend.initial_packet_timeout_us=500",
                                          "resend.frame_retention_us=20000",
                                          "resend.request_ratio=0.5",
                                          "light.mains_hz=60",
                                          "trigger.backend=x",
                                          "trigger.rate_hz=30",
                                          "trigger.pulse_width_us=50",
                                          "trigger.wire_port=4000",
                                          "trigger.lines=[\"TRIGGER\"]",
                                          "trigger.active_low=true",
                                          "trigger.loopback_line=TRIGGER_BACK",
                                          "trigger.loopback_active_low=true",
                                          "trigger.genlock=false",
                                          "trigger.genlock_margin_us=900",
                                          "history.sets=200",
                                          "history.in_flight=10",
                                          "history.size_down=false",
                                          "display.backend=x",
                                          "display.width_px=1920",
                                          "display.height_px=1080",
                                          "display.refresh_hz=60",
                                          "display.rotation_deg=90",
                                          "display.zoom=2",
                                          "display.render_threads=1",
                                          "display.font=/x",
                                          "display.flicker_compensation=true",
                                          "display.device=/dev/dri/card1",
                                          "display.mode=800x600",
                                          "display.queue_depth=2",
                                          "panel.backend=terminal",
                                          "panel.script=/x",
                                          "panel.button_prefix=b-",
                                          "panel.lamp_prefix=l-",
                                          "panel.active_low=false",
                                          "panel.debounce_ms=5",
                                          "depth_sensor.backend=openni",
                                          "depth_sensor.source=/x",
                                          "depth_sensor.drivers=/x",
                                          "depth_sensor.width_px=320",
                                          "depth_sensor.height_px=240",
                                          "depth_sensor.rate_hz=60",
                                          "depth_sensor.colour=false",
                                          "depth_sensor.latency_ms=55",
                                          "depth_sensor.repeat=false",
                                          "director.delay_ladder_s=[1,2]",
                                          "director.sweep_views_per_s=5",
                                          "director.idle_home_s=60",
                                          "record.directory=/x",
                                          "record.video_hz=10",
                                          "record.video_width_px=320",
                                          "realtime.lock_memory=false",
                                          "realtime.require=true",
                                          "realtime.trigger.policy=rr",
                                          "realtime.trigger.priority=81",
                                          "realtime.trigger.cpus=[1]",
                                          "realtime.receive.policy=rr",
                                          "realtime.receive.priority=71",
                                          "realtime.receive.cpus=[1]",
                                          "realtime.render.policy=rr",
                                          "realtime.render.priority=61",
                                          "realtime.render.cpus=[1]",
                                          "realtime.draw.policy=rr",
                                          "realtime.draw.priority=51",
                                          "realtime.draw.cpus=[1]",
                                          "realtime.panel.cpus=[1]",
                                          "state.directory=/x",
                                          "state.trace=/x",
                                          "control.bus=none",
                                          "control.name=x.y"};
  std::set<std::string> tried = {"realtime.panel.policy", "realtime.panel.priority"};
  for (const std::string& text : other) {
    const auto config = parseConfig("", "kagamid.toml", {text});
    ASSERT_TRUE(config.has_value()) << config.error();
    EXPECT_FALSE(*config == Config{}) << text;
    tried.insert(text.substr(0, text.find('=')));
  }
  // These two only go together, so they are the file's business.
  const auto panel = parseConfig("[realtime.panel]\npolicy = \"fifo\"\npriority = 5", "f");
  ASSERT_TRUE(panel.has_value()) << panel.error();
  EXPECT_EQ(panel->realtime.panel.policy, rt::SchedPolicy::kFifo);
  EXPECT_EQ(panel->realtime.panel.priority, 5);
  const auto keys = appliance::configKeys();
  EXPECT_EQ(tried, std::set<std::string>(keys.begin(), keys.end()));
}

TEST(Config, IgnoresAnUnknownKeyOfTheFileAndSaysLineAndSuggestion) {
  const auto config = parseConfig(
      "[trigger]\nrate_hz = 50\n\n[display]\nwidht_px = 800\n[triger]\n", "kagamid.toml");
  ASSERT_TRUE(config.has_value()) << config.error();
  EXPECT_EQ(config->trigger.rate_hz, 50);
  EXPECT_THAT(
      config->warnings,
      testing::UnorderedElementsAre(
          AllOf(StartsWith("kagamid.toml:5: "), HasSubstr("widht_px"), HasSubstr("\"width_px\"?")),
          AllOf(StartsWith("kagamid.toml:6: "), HasSubstr("\"trigger\"?"))));
}

TEST(Config, RefusesAnUnknownKeyThatAPersonTyped) {
  EXPECT_THAT(faultOf("", {"display.widht_px=800"}),
              AllOf(StartsWith("--set display.widht_px=800: "), HasSubstr("\"width_px\"?")));
}

TEST(Config, AcceptsAKeyOfAnEarlierVersionAndSaysThatItHasNoEffect) {
  const auto config = parseConfig("[history]\nsets = 200\nreserve = 4\n", "kagamid.toml");
  ASSERT_TRUE(config.has_value()) << config.error();
  EXPECT_EQ(config->history.sets, 200U);
  ASSERT_EQ(config->warnings.size(), 1U);
  EXPECT_THAT(config->warnings[0], StartsWith("history.reserve has no effect any more"));
  EXPECT_TRUE(parseConfig("[history]\nsets = 200\n", "kagamid.toml")->warnings.empty());
}

TEST(Config, RefusesWrongTypesAndRangesInOneLine) {
  EXPECT_THAT(faultOf("[trigger]\nrate_hz = \"fast\""),
              AllOf(StartsWith("kagamid.toml:2: "), HasSubstr("rate_hz must be a number")));
  EXPECT_THAT(faultOf("[trigger]\nrate_hz = 0"), HasSubstr("rate_hz must be from 0.1 to 1000 Hz"));
  EXPECT_THAT(faultOf("[history]\nsets = 65535"), HasSubstr("sets must be from 2 to 60000"));
  EXPECT_THAT(faultOf("[cameras]\npixel_format = \"RGB\""),
              HasSubstr("pixel_format must be one of BayerRG8, "));
  EXPECT_THAT(faultOf("[cameras]\naddresses = [\"cam1\"]"), HasSubstr("not an IPv4 address"));
  EXPECT_THAT(faultOf("[cameras]\naddresses = [\"10.0.0.1\", \"10.0.0.1\"]"),
              HasSubstr("stands twice"));
  EXPECT_THAT(faultOf("[trigger]\nwire_port = 0"), HasSubstr("wire_port"));
  EXPECT_THAT(faultOf("[director]\ndelay_ladder_s = [2, 1]"), HasSubstr("rising"));
  EXPECT_THAT(faultOf("[director]\ndelay_ladder_s = []"), HasSubstr("one or more"));
  EXPECT_THAT(faultOf("[realtime.render]\npriority = 0"), HasSubstr("priority must be 1 to 99"));
  EXPECT_THAT(faultOf("[rig]\nfile = \"\""), HasSubstr("must not be empty"));
  EXPECT_EQ(faultOf("[rig]\nfile = \"\"").find('\n'), std::string::npos);
}

TEST(Config, TakesCoverOrANumberAsTheZoom) {
  const auto zoomOf = [](const std::string& text) {
    const auto config = parseConfig(text, "kagamid.toml");
    EXPECT_TRUE(config.has_value()) << config.error();
    return config ? config->display.zoom : std::optional<double>(-1);
  };
  EXPECT_EQ(zoomOf(""), std::nullopt);
  EXPECT_EQ(zoomOf("[display]\nzoom = \"cover\""), std::nullopt);
  EXPECT_EQ(zoomOf("[display]\nzoom = 1.5"), 1.5);
  EXPECT_THAT(faultOf("[display]\nzoom = \"fill\""),
              HasSubstr("zoom must be a number or \"cover\", not \"fill\""));
  EXPECT_THAT(faultOf("[display]\nzoom = 0.01"), HasSubstr("zoom must be from 0.1 to 20"));
}

TEST(Config, RefusesKeysThatContradictEachOther) {
  EXPECT_THAT(faultOf("[cameras]\nexposure_us = 25000"), HasSubstr("shorter than the trigger's"));
  EXPECT_THAT(faultOf("[trigger]\npulse_width_us = 25000"), HasSubstr("shorter than"));
  EXPECT_THAT(faultOf("[panel]\nlamp_prefix = \"button-\""), HasSubstr("must differ"));
  EXPECT_THAT(faultOf("[history]\nin_flight = 2"), HasSubstr("in_flight must be at least 3"));
  EXPECT_THAT(faultOf("[resend]\nframe_retention_us = 30000",
                      {"trigger.rate_hz=1000", "cameras.exposure_us=500"}),
              HasSubstr("in_flight must be at least 32"));
  EXPECT_THAT(faultOf("[resend]\nframe_retention_us = 2000"),
              HasSubstr("frame_retention_us must not be below packet_timeout_us"));
}

TEST(Config, RefusesAWaitThatAReceiveThreadWouldSpinIn) {
  EXPECT_THAT(faultOf("[resend]\npacket_timeout_us = 500"),
              HasSubstr("packet_timeout_us must be from 1000"));
}

TEST(Config, GivesAModelItsOwnResendsAndTheCommonOnesForTheRest) {
  const auto config = parseConfig(
      "[resend]\nrequest_ratio = 0.5\n"
      "[[resend.model]]\nname = \"acA1300-75gc\"\npacket_timeout_us = 8000\n"
      "[[resend.model]]\nname = \"Blackfly\"\nenabled = false\n",
      "f");
  ASSERT_TRUE(config.has_value()) << config.error();
  EXPECT_EQ(config->resend.policy.packet_timeout_us, 3000U);
  ASSERT_EQ(config->resend.models.size(), 2U);
  EXPECT_EQ(config->resend.models[0].model, "acA1300-75gc");
  EXPECT_EQ(config->resend.models[0].policy.packet_timeout_us, 8000U);
  EXPECT_EQ(config->resend.models[0].policy.request_ratio, 0.5);
  EXPECT_FALSE(config->resend.models[1].policy.enabled);

  EXPECT_THAT(faultOf("[[resend.model]]\npacket_timeout_us = 8000"), HasSubstr("name"));
  const auto misspelt = parseConfig("[[resend.model]]\nname = \"a\"\npacket_timout_us = 8000", "f");
  ASSERT_TRUE(misspelt.has_value()) << misspelt.error();
  EXPECT_THAT(misspelt->warnings, testing::ElementsAre(HasSubstr("\"packet_timeout_us\"?")));
  EXPECT_THAT(faultOf("[[resend.model]]\nname = \"a\"\n[[resend.model]]\nname = \"a\""),
              HasSubstr("stands twice"));
}

TEST(Config, OverridesTakeTomlValuesAndBareText) {
  const auto config = parseConfig("[trigger]\nrate_hz = 30", "f",
                                  {"trigger.rate_hz=50", "rig.file=/tmp/a \"b\".toml",
                                   "cameras.addresses=[\"127.0.0.1\", \"127.0.0.2\"]",
                                   "realtime.render.priority=55", "control.bus=none"});
  ASSERT_TRUE(config.has_value()) << config.error();
  EXPECT_EQ(config->trigger.rate_hz, 50);
  EXPECT_EQ(config->rig.file, "/tmp/a \"b\".toml");
  EXPECT_EQ(config->cameras.addresses.size(), 2u);
  EXPECT_EQ(config->realtime.render.priority, 55);
  EXPECT_EQ(config->control.bus, "none");
}

TEST(Config, NamesTheOverrideThatIsWrong) {
  EXPECT_THAT(faultOf("", {"trigger.rate=50"}),
              AllOf(StartsWith("--set trigger.rate=50: "), HasSubstr("unknown key")));
  EXPECT_THAT(faultOf("", {"rate_hz=50"}), HasSubstr("not of the form section.key=value"));
  EXPECT_THAT(faultOf("", {"trigger.rate_hz"}), HasSubstr("not of the form section.key=value"));
  EXPECT_THAT(faultOf("", {"trigger.rate_hz=nan"}), HasSubstr("finite"));
  EXPECT_THAT(faultOf("", {"trigger..rate_hz=4"}), StartsWith("--set trigger..rate_hz=4: "));
  EXPECT_THAT(faultOf("", {"rig.file=a\n[trigger]\nrate_hz=1"}), testing::StrEq("no fault"));
}

TEST(Config, TellsAMissingFileFromAMalformedOne) {
  EXPECT_THAT(loadConfig("/nonexistent/kagamid.toml").error(),
              AllOf(HasSubstr("/nonexistent/kagamid.toml"), HasSubstr("No such file")));
  EXPECT_THAT(faultOf("[trigger\nrate_hz = 1"), StartsWith("kagamid.toml:1: "));
}

}  // namespace
