#include <array>
#include <chrono>
#include <stop_token>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/box/box.h"
#include "appliance/control/control_server.h"
#include "appliance/loop/event_loop.h"
#include "tests/support/becomes_true.h"
#include "tests/support/no_display.h"
#include "tests/support/output_of.h"
#include "tests/support/private_bus.h"
#include "tests/support/small_site.h"
#include "tests/unit/sample_part/sample_part.h"

namespace {

using appliance::Box;
using testing::HasSubstr;

appliance::MadePart makeSample(const appliance::Shared& shared) {
  return appliance::makeSamplePart(shared, {});
}

/// Serves @p box on the bus at @p address until stopped: what main does.
void serve(Box& box, const std::string& address, const std::stop_token& stop) {
  const auto loop = appliance::EventLoop::create();
  ASSERT_TRUE(loop.has_value()) << loop.error();
  appliance::ControlServer server(**loop, {.bus = address, .name = "org.kagami.Kagami1"}, box, box,
                                  box.jobs());
  for (const appliance::BusObject& object : box.busObjects()) server.show(object);
  ASSERT_TRUE((*loop)->every(std::chrono::milliseconds(10), [&] {
    server.collectAnswers();
    server.tick(rt::now(), box.status());
    if (stop.stop_requested()) (*loop)->requestStop();
  }));
  const auto ended = (*loop)->run();
  EXPECT_TRUE(ended.has_value()) << ended.error();
}

TEST(BoxOnTheBus, ShowsAPartsOwnObjectAndItsLineInTheStatus) {
  const test::PrivateBus bus;
  if (bus.address().empty())
    GTEST_SKIP() << "dbus-daemon cannot be started here (package dbus-daemon)";
  if (test::outputOf("busctl --version").find("systemd") == std::string::npos)
    GTEST_SKIP() << "busctl is not installed (package systemd)";
  test::NoDisplay display;
  const std::array<appliance::PartEntry, 1> parts = {{{makeSample}}};
  auto box = Box::start(test::smallSite(), {.display = display, .parts = parts});
  ASSERT_TRUE(box.has_value()) << box.error();
  {
    const std::jthread serving(
        [&](const std::stop_token& stop) { serve(**box, bus.address(), stop); });
    const std::string busctl = "busctl --address='" + bus.address() + "' ";
    const std::string sample =
        " org.kagami.Kagami1 /org/kagami/Kagami1/sample org.kagami.Kagami1.Sample ";
    EXPECT_TRUE(test::becomesTrue([&] {
      return test::outputOf(busctl + "get-property" + sample + "Turns").starts_with("x ");
    }));
    EXPECT_EQ(test::outputOf(busctl + "call" + sample + "Reset"), "");
    EXPECT_THAT(
        test::outputOf(busctl + "call org.kagami.Kagami1 /org/kagami/Kagami1 org.kagami.Kagami1 "
                                "Status"),
        HasSubstr("counting"));
  }
  EXPECT_TRUE((*box)->stop().has_value());
}

}  // namespace
