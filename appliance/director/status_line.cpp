#include "appliance/director/status_line.h"

#include <string>
#include <string_view>

namespace appliance {
namespace {

/// Appends to a line.
class LineWriter {
 public:
  explicit LineWriter(std::string& line) : line_(line) {}

  LineWriter& operator<<(std::string_view text) {
    line_ += text;
    return *this;
  }
  LineWriter& operator<<(std::uint64_t number) { return *this << std::to_string(number); }

  /// Seconds with @p decimals places, rounded.
  void seconds(rt::Nanoseconds time, int decimals) {
    std::uint64_t unit_ns = 1'000'000'000;
    for (int i = 0; i < decimals; ++i) unit_ns /= 10;
    const auto time_ns = static_cast<std::uint64_t>(time.count() < 0 ? 0 : time.count());
    const std::uint64_t units = (time_ns + unit_ns / 2) / unit_ns;
    const std::uint64_t per_second = 1'000'000'000 / unit_ns;
    *this << units / per_second << ".";
    for (std::uint64_t place = per_second / 10; place != 0; place /= 10) {
      *this << units / place % 10;
    }
    *this << " s";
  }

 private:
  std::string& line_;
};

/// How long ago the shown moment was, nothing for the newest one.
void writeAge(LineWriter& out, rt::Nanoseconds delay) {
  constexpr rt::Nanoseconds kShownAsZero = std::chrono::milliseconds(5);
  if (delay < kShownAsZero) return;
  out << " -";
  out.seconds(delay, 2);
}

void writeMode(LineWriter& out, const Shot& shot) {
  switch (shot.mode) {
    case Mode::kLive:
      out << "LIVE";
      break;
    case Mode::kDelayed:
      out << "DELAY ";
      out.seconds(shot.delay, 1);
      break;
    case Mode::kFrozen:
      out << "FROZEN";
      writeAge(out, shot.delay);
      break;
    case Mode::kSweep:
      out << "SWEEP";
      writeAge(out, shot.delay);
      break;
    case Mode::kSlow:
      out << "SLOW " << nameOf(shot.rate);
      writeAge(out, shot.delay);
      break;
  }
}

std::string_view reasonOf(Substitute substitute) {
  switch (substitute) {
    case Substitute::kNone:
      break;
    case Substitute::kLost:
      return " lost";
    case Substitute::kNoFrame:
      return " has no picture of this moment";
    case Substitute::kCannotSee:
      return " cannot see the target";
  }
  return "";
}

void writeBadge(LineWriter& out, const Shot& shot) {
  if (shot.substitute == Substitute::kNone) return;
  out << "   camera " << std::uint64_t{shot.camera_wanted} + 1 << reasonOf(shot.substitute);
  if (shot.camera_shown != shot.camera_wanted) {
    out << ": showing " << std::uint64_t{shot.camera_shown} + 1;
  } else if (shot.trigger != 0) {
    out << ": showing its last picture";
  }
}

}  // namespace

StatusText statusText(const Shot& shot, std::uint32_t cameras) {
  StatusText line;
  LineWriter out(line.text);
  writeMode(out, shot);
  out << "   view " << std::uint64_t{shot.camera_wanted} + 1 << "/" << std::uint64_t{cameras};
  if (shot.at_history_end) out << "   end of memory";
  if (shot.trigger == 0) out << "   no picture yet";
  writeBadge(out, shot);
  line.warning = shot.substitute != Substitute::kNone || shot.trigger == 0;
  return line;
}

}  // namespace appliance
