#include "hal/gpiod/trigger_line.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <gpiod.hpp>

#include "hal/gpiod/line_finder.h"
#include "hal/gpiod/requests.h"
#include "rt/section.h"

namespace hal::gpiod {
namespace {

constexpr const char* kKey = "trigger.lines";

class GpioTriggerLine final : public TriggerLine {
 public:
  explicit GpioTriggerLine(::gpiod::line_request request)
      : request_(std::move(request)),
        offsets_(request_.offsets()),
        active_(offsets_.size(), ::gpiod::line::value::ACTIVE),
        inactive_(offsets_.size(), ::gpiod::line::value::INACTIVE) {}

  ~GpioTriggerLine() override { (void)setActive(false); }
  GpioTriggerLine(const GpioTriggerLine&) = delete;
  GpioTriggerLine& operator=(const GpioTriggerLine&) = delete;

  rt::Result<TriggerEdge> setActive(bool active) RT_SAFE override {
    const auto lost = [](int os_errno) {
      return std::unexpected(
          rt::Error{rt::Errc::kDeviceLost, os_errno, "drive the trigger's GPIO lines"});
    };
    const rt::ScopedRtExemption ioctl("writes a register; allocates only to throw");
    const rt::Timestamp before = rt::now();
    try {
      // The one overload that allocates nothing: both vectors are there already.
      request_.set_values(offsets_, active ? active_ : inactive_);
    } catch (const std::system_error& error) {
      return lost(error.code().value());
    } catch (...) {
      return lost(0);
    }
    return TriggerEdge{before, rt::now()};
  }

 private:
  ::gpiod::line_request request_;
  const ::gpiod::line::offsets offsets_;
  const ::gpiod::line::values active_;
  const ::gpiod::line::values inactive_;
};

/// All lines on one chip that the CPU writes itself, or why not.
std::expected<std::vector<ListedLine>, std::string> findTriggerLines(
    const LineList& list, const std::vector<std::string>& names) {
  std::vector<ListedLine> lines;
  for (const std::string& name : names) {
    auto line = findLine(list, name, kKey);
    if (!line) return std::unexpected(std::move(line.error()));
    if (!line->bus.empty())
      return std::unexpected(std::string(kKey) + ": GPIO line \"" + name + "\" on " + line->chip +
                             " (" + line->chip_label + ") is behind an expander on the bus " +
                             line->bus +
                             ", whose edges come late and unevenly: wire the trigger to a line of "
                             "the board itself");
    if (std::ranges::find(lines, name, &ListedLine::name) != lines.end())
      return std::unexpected(std::string(kKey) + ": \"" + name +
                             "\" stands twice: name every line once");
    if (!lines.empty() && line->chip != lines.front().chip)
      return std::unexpected(std::string(kKey) + ": \"" + lines.front().name + "\" is on " +
                             lines.front().chip + ", \"" + name + "\" is on " + line->chip +
                             ": lines that fire together must be on one chip");
    lines.push_back(std::move(*line));
  }
  return lines;
}

}  // namespace

std::expected<std::unique_ptr<TriggerLine>, std::string> openTriggerLine(
    const TriggerLineSettings& settings, const std::filesystem::path& sysfs) {
  if (settings.lines.empty())
    return std::unexpected(std::string(kKey) +
                           " is empty: name the GPIO lines that fire the cameras");
  const auto lines = findTriggerLines(listLines(sysfs), settings.lines);
  if (!lines) return std::unexpected(lines.error());
  ::gpiod::line_settings output;
  output.set_direction(::gpiod::line::direction::OUTPUT)
      .set_drive(::gpiod::line::drive::PUSH_PULL)
      .set_active_low(settings.active_low)
      .set_output_value(::gpiod::line::value::INACTIVE);
  auto request = requestLines(*lines, output, kKey);
  if (!request) return std::unexpected(request.error());
  return std::make_unique<GpioTriggerLine>(std::move(*request));
}

}  // namespace hal::gpiod
