#include "hal/emulated/rig/fault_command.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

namespace emulator {
namespace {

enum class Argument : std::uint8_t { kNone, kSwitch, kWhole, kReal };

struct Form {
  Fault fault;
  std::string_view name;
  Argument argument = Argument::kNone;
  double min = 0;
  double max = 0;
  std::optional<double> otherwise{};  // an argument that may be left out
};

constexpr std::array kForms = {
    Form{Fault::kIgnoreTriggers, "ignore-triggers", Argument::kWhole, 0, 1e6},
    Form{Fault::kIgnoreEvery, "ignore-every", Argument::kWhole, 0, 1e6},
    Form{Fault::kExtraFrame, "extra-frame"},
    Form{Fault::kLateLeader, "late-leader", Argument::kReal, 0, 10'000},
    Form{Fault::kKill, "kill"},
    Form{Fault::kRevive, "revive"},
    Form{Fault::kReboot, "reboot", Argument::kReal, 0, 3600, 1},
    Form{Fault::kFreeze, "freeze"},
    Form{Fault::kThaw, "thaw"},
    Form{Fault::kWrongSize, "wrong-size", Argument::kSwitch, 0, 1},
    Form{Fault::kDrift, "drift", Argument::kReal, -10'000, 10'000},
    Form{Fault::kLoss, "loss", Argument::kReal, 0, 100},
    Form{Fault::kReorder, "reorder", Argument::kReal, 0, 100},
    Form{Fault::kDuplicate, "duplicate", Argument::kReal, 0, 100},
    Form{Fault::kFrameId, "frame-id", Argument::kWhole, 1, 65'535},
    Form{Fault::kLink, "link", Argument::kWhole, 1, 100'000},
    Form{Fault::kMtu, "mtu", Argument::kWhole, 68, 65'535},
    Form{Fault::kClear, "clear"},
};

const Form& formOf(Fault fault) {
  return *std::ranges::find(kForms, fault, &Form::fault);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string quoted(std::string_view text) {
  // What came over the wire goes back to a terminal: no control characters, not without end.
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  std::ranges::replace_if(shown, [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return "'" + shown + (text.size() > kLongest ? "...'" : "'");
}

std::vector<std::string_view> wordsOf(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<std::string_view> words;
  while (true) {
    const auto begin = text.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return words;
    text.remove_prefix(begin);
    const auto end = std::min(text.find_first_of(kSpace), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

/// Only what is a number from the first character to the last.
template <class T>
std::optional<T> whole(std::string_view word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::expected<std::optional<std::uint32_t>, std::string> parseCamera(std::string_view word,
                                                                     std::uint32_t cameras) {
  if (word == "all") return std::optional<std::uint32_t>{};
  const auto camera = whole<std::uint32_t>(word);
  if (camera && *camera >= 1 && *camera <= cameras) return *camera - 1;
  return std::unexpected("no camera " + quoted(word) + ": say 1 to " + std::to_string(cameras) +
                         ", or all");
}

std::string usage(const Form& form) {
  std::string text(form.name);
  if (form.argument == Argument::kSwitch) return text + " on|off";
  if (form.argument == Argument::kNone) return text + " without an argument";
  text += form.argument == Argument::kWhole ? " with a whole number from " : " with a number from ";
  return text + number(form.min) + " to " + number(form.max);
}

std::optional<double> parseArgument(const Form& form, std::optional<std::string_view> word) {
  if (!word) return form.argument == Argument::kNone ? 0 : form.otherwise;
  switch (form.argument) {
    case Argument::kNone:
      return std::nullopt;
    case Argument::kSwitch:
      if (*word == "on") return 1;
      return *word == "off" ? std::optional<double>(0) : std::nullopt;
    case Argument::kWhole:
    case Argument::kReal:
      break;
  }
  const auto value = whole<double>(*word);
  if (!value || !(*value >= form.min && *value <= form.max)) return std::nullopt;
  if (form.argument == Argument::kWhole && std::floor(*value) != *value) return std::nullopt;
  return value;
}

}  // namespace

std::string_view nameOf(Fault fault) {
  return formOf(fault).name;
}

std::expected<FaultCommand, std::string> parseFaultCommand(std::string_view text,
                                                           std::uint32_t cameras) {
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  const auto words = wordsOf(text);
  if (words.size() < 2) {
    return std::unexpected(quoted(text) + " is no fault: say <camera | all> <fault> [argument]");
  }
  const auto camera = parseCamera(words[0], cameras);
  if (!camera) return std::unexpected(camera.error());
  const auto* form = std::ranges::find(kForms, words[1], &Form::name);
  if (form == kForms.end()) {
    std::string all;
    for (const Form& known : kForms) all.append(all.empty() ? "" : ", ").append(known.name);
    return std::unexpected("no fault " + quoted(words[1]) + ": there are " + all);
  }
  const auto word = words.size() > 2 ? std::optional<std::string_view>(words[2])
                                     : std::optional<std::string_view>();
  const auto argument = parseArgument(*form, word);
  if (!argument || words.size() > 3) return std::unexpected("say " + usage(*form));
  return FaultCommand{*camera, form->fault, *argument};
}

std::string faultText(const FaultCommand& command) {
  const Form& form = formOf(command.fault);
  std::string text(form.name);
  if (form.argument == Argument::kNone) return text;
  if (form.argument == Argument::kSwitch) return text + (command.argument != 0 ? " on" : " off");
  return text + " " + number(command.argument);
}

}  // namespace emulator
