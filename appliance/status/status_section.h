#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "appliance/words/phrase.h"

namespace appliance {

/// Something that is less than configured, for a person. Texts are UTF-8: D-Bus refuses others.
struct Remark {
  std::string key;             ///< who it is about, the same while it lasts: "panel", "camera 7"
  std::string text;            ///< what is wrong and what to do
  Word word = Word::kNothing;  ///< what the text says

  friend bool operator==(const Remark&, const Remark&) = default;
};

[[nodiscard]] inline Remark remarkOf(std::string key, const Phrase& phrase) {
  return {.key = std::move(key), .text = textOf(phrase), .word = phrase.word};
}

/// One figure or word of a section; its name carries the unit: "rate_hz".
struct StatusValue {
  using Value = std::variant<bool, std::int64_t, double, std::string>;
  std::string name;
  Value value;

  friend bool operator==(const StatusValue&, const StatusValue&) = default;
};

/// What one part reports about itself: once as a line for people, once as values for programs.
struct StatusSection {
  std::string key;   ///< unique in the box, lower_snake: "depth_sensor"
  std::string line;  ///< empty: nothing to say
  std::vector<StatusValue> values = {};

  friend bool operator==(const StatusSection&, const StatusSection&) = default;
};

}  // namespace appliance
