#include "hal/gpiod/panel.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include <gpiod.hpp>

#include "hal/gpiod/edge_waiter.h"
#include "hal/gpiod/line_finder.h"
#include "hal/gpiod/requests.h"

namespace hal::gpiod {
namespace {

/// Where a button or lamp is: which request, which line of it.
struct Place {
  std::size_t request = 0;
  unsigned offset = 0;
};

template <std::size_t N>
using Places = std::array<std::optional<Place>, N>;
using ButtonPlaces = Places<kButtons.size()>;
using LampPlaces = Places<kLamps.size()>;

class GpioPanel final : public ButtonPanel {
 public:
  GpioPanel(std::vector<::gpiod::line_request> buttons, const ButtonPlaces& button_places,
            std::vector<::gpiod::line_request> lamps, const LampPlaces& lamp_places)
      : edges_(std::move(buttons)),
        buttons_(button_places),
        lamp_requests_(std::move(lamps)),
        lamps_(lamp_places) {}

  ~GpioPanel() override {
    for (std::size_t i = 0; i < lamps_.size(); ++i) setLamp(static_cast<Lamp>(i), false);
  }
  GpioPanel(const GpioPanel&) = delete;
  GpioPanel& operator=(const GpioPanel&) = delete;

  std::optional<ButtonEvent> waitEvent(rt::Nanoseconds timeout) override {
    const auto edge = edges_.wait(timeout);
    if (!edge) return std::nullopt;
    const auto* place = std::ranges::find_if(buttons_, [&](const auto& of_button) {
      return of_button && of_button->request == edge->request && of_button->offset == edge->offset;
    });
    return ButtonEvent{.button = static_cast<Button>(place - buttons_.begin()),
                       .pressed = edge->active,
                       .at = edge->at};
  }

  bool isPressed(Button button) override {
    const auto& place = buttons_[static_cast<std::size_t>(button)];
    if (!place) return false;
    try {
      return edges_.request(place->request).get_value(place->offset) ==
             ::gpiod::line::value::ACTIVE;
    } catch (const std::exception&) {
      lost_ = true;
      return false;
    }
  }

  void setLamp(Lamp lamp, bool on) override {
    const auto& place = lamps_[static_cast<std::size_t>(lamp)];
    if (!place) return;
    try {
      lamp_requests_[place->request].set_value(
          place->offset, on ? ::gpiod::line::value::ACTIVE : ::gpiod::line::value::INACTIVE);
    } catch (const std::exception&) {
      lost_ = true;
    }
  }

  [[nodiscard]] bool alive() const override { return !lost_ && !edges_.lost(); }

 private:
  EdgeWaiter edges_;
  ButtonPlaces buttons_;
  std::vector<::gpiod::line_request> lamp_requests_;
  LampPlaces lamps_;
  bool lost_ = false;
};

/// The lines of all buttons, or of all lamps.
template <std::size_t N>
struct Claim {
  std::vector<::gpiod::line_request> requests;
  Places<N> places;
  std::vector<std::string> missing;  // names of lines that are not there
  std::vector<std::string> notes;
};

/// Claims those of the lines @p prefix + name that exist, one request per chip.
template <class Row, std::size_t N>
std::expected<Claim<N>, std::string> claimLines(const LineList& list, const std::string& prefix,
                                                const std::array<Row, N>& rows,
                                                const ::gpiod::line_settings& settings,
                                                const std::string& key) {
  Claim<N> claim;
  std::vector<std::vector<ListedLine>> by_chip;
  for (std::size_t i = 0; i < N; ++i) {
    const std::string name = prefix + std::string(rows[i].name);
    auto line = findOptionalLine(list, name, key);
    if (!line) return std::unexpected(std::move(line.error()));
    if (!*line) {
      claim.missing.push_back(name);
      continue;
    }
    auto chip = std::ranges::find_if(
        by_chip, [&](const auto& lines) { return lines.front().chip == (*line)->chip; });
    if (chip == by_chip.end()) chip = by_chip.emplace(chip);
    claim.places[i] = {static_cast<std::size_t>(chip - by_chip.begin()), (*line)->offset};
    chip->push_back(std::move(**line));
  }
  for (const auto& lines : by_chip) {
    auto request = requestLines(lines, settings, key);
    if (!request) return std::unexpected(std::move(request.error()));
    claim.requests.push_back(std::move(*request));
    const ListedLine& first = lines.front();
    if (!first.bus.empty())
      claim.notes.push_back(key + ": \"" + first.name + "\" is behind an expander on the bus " +
                            first.bus + ": the panel works, its instants are late");
  }
  return claim;
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "\"" : ", \"") + name + '"';
  return all;
}

}  // namespace

std::expected<OpenedPanel, std::string> openButtonPanel(const PanelSettings& settings,
                                                        const std::filesystem::path& sysfs) {
  const LineList list = listLines(sysfs);
  ::gpiod::line_settings contact;
  contact.set_direction(::gpiod::line::direction::INPUT)
      .set_edge_detection(::gpiod::line::edge::BOTH)
      .set_event_clock(::gpiod::line::clock::MONOTONIC)
      .set_debounce_period(settings.debounce)
      .set_active_low(settings.active_low);
  auto buttons = claimLines(list, settings.button_prefix, kButtons, contact, "panel.button_prefix");
  if (!buttons) return std::unexpected(buttons.error());
  if (buttons->requests.empty()) {
    // The first one's message names what is near.
    return std::unexpected(findLine(list, buttons->missing.front(), "panel.button_prefix").error());
  }
  ::gpiod::line_settings output;
  output.set_direction(::gpiod::line::direction::OUTPUT)
      .set_output_value(::gpiod::line::value::INACTIVE);
  auto lamps = claimLines(list, settings.lamp_prefix, kLamps, output, "panel.lamp_prefix");
  if (!lamps) return std::unexpected(lamps.error());

  OpenedPanel opened;
  opened.notes = std::move(buttons->notes);
  if (!buttons->missing.empty())
    opened.notes.push_back("panel: no GPIO line is named " + joined(buttons->missing) +
                           ": these buttons are not there");
  if (!lamps->missing.empty())
    opened.notes.push_back("panel: no GPIO line is named " + joined(lamps->missing) +
                           ": these lamps stay off");
  opened.panel = std::make_unique<GpioPanel>(std::move(buttons->requests), buttons->places,
                                             std::move(lamps->requests), lamps->places);
  for (const auto& [button, name] : kButtons) {
    if (opened.panel->isPressed(button))
      opened.notes.push_back("panel: the button " + std::string(name) +
                             " is held down or stuck: it is ignored until released");
  }
  return opened;
}

}  // namespace hal::gpiod
