#include "tests/kernel/support/gpio_trace.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/kernel/support/files.h"

namespace test {
namespace {

const std::string kTracing = "/sys/kernel/tracing";
constexpr std::size_t kPageBytes = 4096;

template <class T>
T at(std::span<const char> bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof value <= bytes.size()) {
    std::memcpy(&value, bytes.data() + offset, sizeof value);
  }
  return value;
}

/// Reads one page of the trace's binary form; its text form rounds to microseconds. The layout is
/// what the kernel writes in events/header_page, events/header_event and
/// events/gpio/gpio_value/format: a page begins with the time and the number of its bytes, an event
/// with 5 bits of kind and 27 bits of time since the one before.
void readPage(std::span<const char> page, std::uint16_t gpio_value, std::vector<GpioEvent>& into) {
  constexpr std::uint32_t kPadding = 29;
  constexpr std::uint32_t kTimeExtension = 30;
  constexpr std::uint32_t kAbsoluteTime = 31;
  constexpr std::size_t kPageHeader = 16;
  constexpr std::uint64_t kLengthMask = 0xfffff;  // above it: whether events were lost

  auto time = at<std::uint64_t>(page, 0);
  const auto length = static_cast<std::size_t>(at<std::uint64_t>(page, 8) & kLengthMask);
  const std::span<const char> events =
      page.subspan(kPageHeader, std::min(length, page.size() - kPageHeader));
  for (std::size_t offset = 0; offset + 4 <= events.size();) {
    const auto header = at<std::uint32_t>(events, offset);
    const std::uint32_t kind = header & 31;
    const std::uint64_t delta = header >> 5;
    const std::uint64_t word = at<std::uint32_t>(events, offset + 4);
    if (kind == kPadding) {
      if (delta == 0) return;  // the rest of the page is empty
      time += delta;
      offset += 4 + word;
    } else if (kind == kTimeExtension) {
      time += delta + (word << 27);
      offset += 8;
    } else if (kind == kAbsoluteTime) {
      constexpr std::uint64_t kKept = std::uint64_t{31} << 59;  // bits that do not fit
      time = (time & kKept) | delta | (word << 27);
      offset += 8;
    } else {
      time += delta;
      // A length that does not fit into the kind stands in the first word, which it counts too.
      const std::size_t data = offset + (kind == 0 ? 8 : 4);
      if (at<std::uint16_t>(events, data) == gpio_value) {
        into.push_back({.number = at<std::uint32_t>(events, data + 8),
                        .written = at<std::int32_t>(events, data + 12) == 0,
                        .level = at<std::int32_t>(events, data + 16) != 0,
                        .time_ns = static_cast<std::int64_t>(time)});
      }
      offset += 4 + (kind == 0 ? word : std::size_t{kind} * 4);
    }
  }
}

/// The number that events of this kind bear in the binary trace.
std::uint16_t eventId() {
  const std::string format = readAttribute(kTracing + "/events/gpio/gpio_value/format");
  const std::size_t at = format.find("ID: ");
  if (at == std::string::npos) throw std::runtime_error("the format of gpio_value has no ID");
  return static_cast<std::uint16_t>(std::stoul(format.substr(at + 4)));
}

/// A file that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// The chip and offset of a line by its name.
struct LinePlace {
  std::string chip;
  std::uint32_t offset = 0;
  std::uint32_t lines = 0;  ///< of the chip
};

std::optional<LinePlace> findLine(const std::string& name) {
  for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
    const std::string path = entry.path();
    if (!path.starts_with("/dev/gpiochip")) continue;
    const Descriptor chip(::open(path.c_str(), O_RDWR | O_CLOEXEC));
    gpiochip_info info{};
    if (::ioctl(chip.get(), GPIO_GET_CHIPINFO_IOCTL, &info) != 0) continue;
    for (std::uint32_t i = 0; i < info.lines; ++i) {
      gpio_v2_line_info line{};
      line.offset = i;
      if (::ioctl(chip.get(), GPIO_V2_GET_LINEINFO_IOCTL, &line) == 0 && name == line.name) {
        return LinePlace{.chip = path, .offset = i, .lines = info.lines};
      }
    }
  }
  return std::nullopt;
}

/// Reads a line once, its direction left as it is; false when another program has it.
bool readLine(const std::string& path, std::uint32_t offset) {
  const Descriptor chip(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  gpio_v2_line_request request{};
  request.offsets[0] = offset;
  request.num_lines = 1;
  if (::ioctl(chip.get(), GPIO_V2_GET_LINE_IOCTL, &request) != 0) return false;
  const Descriptor line(request.fd);
  gpio_v2_line_values values{};
  values.mask = 1;
  return ::ioctl(line.get(), GPIO_V2_LINE_GET_VALUES_IOCTL, &values) == 0;
}

}  // namespace

GpioTrace::GpioTrace(std::string name) : folder_(kTracing + "/instances/" + name) {
  if (::mkdir(folder_.c_str(), 0755) != 0) {
    throw std::runtime_error("cannot make " + folder_ + ": " + std::strerror(errno));
  }
  writeAttribute(folder_ + "/trace_clock", "mono");
  event_id_ = eventId();
  for (const auto& cpu : std::filesystem::directory_iterator(folder_ + "/per_cpu")) {
    const std::string path = cpu.path() / "trace_pipe_raw";
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno));
    pages_.push_back(fd);
  }
  writeAttribute(folder_ + "/events/gpio/gpio_value/enable", "1");
}

GpioTrace::~GpioTrace() {
  for (const int fd : pages_) ::close(fd);
  ::rmdir(folder_.c_str());
}

std::vector<GpioEvent> GpioTrace::take() {
  std::vector<GpioEvent> events;
  std::array<char, kPageBytes> page{};
  for (const int fd : pages_) {
    for (ssize_t bytes = 0; (bytes = ::read(fd, page.data(), page.size())) > 0;) {
      readPage({page.data(), static_cast<std::size_t>(bytes)}, event_id_, events);
    }
  }
  std::ranges::stable_sort(events, {}, &GpioEvent::time_ns);
  return events;
}

std::uint32_t GpioTrace::numberOf(const std::string& line) {
  const auto place = findLine(line);
  if (!place) throw std::runtime_error("no GPIO line is named '" + line + "'");
  GpioTrace trace("number-of-" + line);
  for (std::uint32_t free = 0; free < place->lines; ++free) {
    if (!readLine(place->chip, free)) continue;
    for (const GpioEvent& event : trace.take()) {
      if (!event.written) return event.number - free + place->offset;
    }
  }
  throw std::runtime_error("no line of " + place->chip + " could be read to find the number of '" +
                           line + "'");
}

std::vector<GpioEvent> outputEdges(std::span<const GpioEvent> events, std::uint32_t number,
                                   std::optional<bool> before) {
  std::vector<GpioEvent> edges;
  for (const GpioEvent& event : events) {
    if (event.number != number || !event.written || before == event.level) continue;
    before = event.level;
    edges.push_back(event);
  }
  return edges;
}

}  // namespace test
