// kagami-depth-feeder: gives the emulated depth sensor something to see where no studio runs: a
// room with a person who walks.

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "hal/emulated/openni/practice_room.h"
#include "hal/emulated/openni/ring.h"
#include "rt/clock.h"

namespace {

using namespace std::chrono_literals;

volatile std::sig_atomic_t stop_asked = 0;

struct Options {
  std::string ring = emulator::depthRingPath();
  emulator::RgbdFormat format;
  double seconds = 0;
  double unplug_every_s = 0;
  double unplug_for_s = 1;
  std::string lamp_log;
};

/// On or off for 0.3 to 1 s at a time, in an order that never repeats soon.
bool lampAt(double time_s) {
  return std::sin(7 * time_s) + std::sin(4.3 * time_s + 1) > 0;
}

/// When it changed, knowing that it did between two instants.
double lampChange(double before_s, double after_s) {
  const bool then = lampAt(before_s);
  for (int i = 0; i < 40; ++i) {
    const double middle_s = 0.5 * (before_s + after_s);
    (lampAt(middle_s) == then ? before_s : after_s) = middle_s;
  }
  return after_s;
}

int feed(const Options& options) {
  auto ring = emulator::DepthRingWriter::create(options.ring, options.format);
  if (!ring) {
    std::fprintf(stderr, "kagami-depth-feeder: %s\n", ring.error().c_str());
    return 1;
  }
  std::FILE* log = options.lamp_log.empty() ? nullptr : std::fopen(options.lamp_log.c_str(), "we");
  if (log == nullptr && !options.lamp_log.empty()) {
    std::fprintf(stderr, "kagami-depth-feeder: %s cannot be written\n", options.lamp_log.c_str());
    return 1;
  }
  if (log != nullptr) (void)std::setvbuf(log, nullptr, _IOLBF, BUFSIZ);  // read while it grows
  const emulator::PracticeRoom room(options.format);
  const rt::Nanoseconds period(static_cast<std::int64_t>(1e9 / options.format.rate_hz));
  const rt::Timestamp start = rt::now() + period;
  bool lamp = false;
  for (std::int64_t i = 0; stop_asked == 0; ++i) {
    const rt::Timestamp exposure = start + i * period;
    const double time_s = static_cast<double>((exposure - start).count()) * 1e-9;
    if (options.seconds > 0 && time_s >= options.seconds) break;
    const bool lit = lampAt(time_s);
    if (log != nullptr && (lit != lamp || i == 0)) {
      const double before_s = time_s - 1 / options.format.rate_hz;
      const double at_s = i == 0 ? time_s : lampChange(before_s, time_s);
      const auto at_ns = rt::toNs(start) + static_cast<std::int64_t>(at_s * 1e9);
      std::fprintf(log, "%lld %d\n", static_cast<long long>(at_ns), lit ? 1 : 0);
    }
    lamp = lit;
    if (options.unplug_every_s > 0) {
      const double phase = std::fmod(time_s, options.unplug_every_s);
      ring->setPlugged(phase < options.unplug_every_s - options.unplug_for_s);
    }
    if (rt::now() > exposure + period) continue;  // too late, as a sensor on a slow bus leaves out
    room.draw(time_s, lit, ring->begin());
    ring->publish(exposure);
    std::this_thread::sleep_until(exposure);
  }
  if (log != nullptr) (void)std::fclose(log);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Something for the emulated depth sensor to see: a room with a person.",
               "kagami-depth-feeder"};
  Options options;
  app.add_option("--ring", options.ring, "where the sensor's driver looks")->capture_default_str();
  app.add_option("--width", options.format.width_px)->capture_default_str();
  app.add_option("--height", options.format.height_px)->capture_default_str();
  app.add_option("--rate", options.format.rate_hz, "pictures a second")->capture_default_str();
  app.add_option("--seconds", options.seconds, "0: until stopped")->capture_default_str();
  app.add_flag("!--no-colour", options.format.colour, "a sensor without a colour camera");
  app.add_option("--unplug-every", options.unplug_every_s, "seconds; 0: never")
      ->capture_default_str();
  app.add_option("--unplug-for", options.unplug_for_s, "seconds")->capture_default_str();
  app.add_option("--lamp-log", options.lamp_log,
                 "when the lamp in the corner changed, and to what");
  CLI11_PARSE(app, argc, argv);
  options.format.focal_px = 570.0 * options.format.width_px / 640;
  options.format.centre_x_px = 0.5 * (options.format.width_px - 1);
  options.format.centre_y_px = 0.5 * (options.format.height_px - 1);
  for (const int signal : {SIGINT, SIGTERM}) (void)std::signal(signal, [](int) { stop_asked = 1; });
  return feed(options);
}
