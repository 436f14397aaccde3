#pragma once

#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "appliance/box/box.h"
#include "appliance/control/control_server.h"
#include "appliance/loop/event_loop.h"

namespace test {

/// A box that is served on a bus by a thread of its own, as main does; a tick each 10 ms.
class ServedBox {
 public:
  /// @p box outlives this object.
  ServedBox(appliance::Box& box, const std::string& bus)
      : thread_([&box, bus](const std::stop_token& stop) { serve(box, bus, stop); }) {}

 private:
  static void serve(appliance::Box& box, const std::string& bus, const std::stop_token& stop) {
    const auto loop = appliance::EventLoop::create();
    ASSERT_TRUE(loop.has_value()) << loop.error();
    appliance::ControlServer server(**loop, {.bus = bus, .name = "org.kagami.Kagami1"}, box, box,
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

  std::jthread thread_;
};

}  // namespace test
