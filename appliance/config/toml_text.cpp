#include "appliance/config/toml_text.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "rt/edit_distance.h"

namespace appliance {

std::string numberText(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string kindOf(const toml::node& node) {
  std::ostringstream out;
  switch (node.type()) {
    case toml::node_type::string:
      out << "text";
      break;
    case toml::node_type::integer:
      out << "the whole number " << **node.as_integer();
      break;
    case toml::node_type::floating_point:
      out << "the number " << **node.as_floating_point();
      break;
    case toml::node_type::boolean:
      out << (**node.as_boolean() ? "true" : "false");
      break;
    case toml::node_type::array:
      out << "an array of " << node.as_array()->size();
      break;
    case toml::node_type::table:
      out << "a table";
      break;
    default:
      out << "a date or time";
      break;
  }
  return out.str();
}

namespace {

template <class Range, class Value>
std::string textOf(const Range& range, Value lowest, Value highest, std::string (*number)(Value)) {
  using Limits = std::numeric_limits<Value>;
  const std::string unit = *range.unit != '\0' ? std::string(" ") + range.unit : std::string();
  if (highest == Limits::max()) return "at least " + number(lowest) + unit;
  if (lowest == Limits::lowest()) return "at most " + number(highest) + unit;
  return "from " + number(lowest) + " to " + number(highest) + unit;
}

}  // namespace

std::string rangeText(const NumberRange& range) {
  return textOf<NumberRange, double>(range, range.lowest, range.highest, numberText);
}

std::string rangeText(const IntegerRange& range) {
  return textOf<IntegerRange, std::int64_t>(
      range, range.lowest, range.highest, [](std::int64_t value) { return std::to_string(value); });
}

std::optional<std::string_view> closestWord(std::string_view word,
                                            std::span<const std::string_view> known) {
  std::optional<std::string_view> best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    const std::size_t distance = rt::editDistance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace appliance
