#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "appliance/config/toml_reader.h"
#include "rt/clock.h"

namespace appliance {

/// What the reader collects besides the values.
struct ConfigReading {
  /// A person has just typed it: an unknown key is an error. In a file another version may have
  /// written it: then it is ignored with a warning.
  bool typed = false;
  std::vector<std::string> keys;      ///< every key there is, as "section.key"
  std::vector<std::string> warnings;  ///< what was read and has no effect, one line each
};

/// Reads the keys of one table into their fields. A field whose key is absent keeps its value. Each
/// key is named once.
class Section {
 public:
  Section(TomlTable table, std::string path, ConfigReading& reading)
      : table_(std::move(table)), path_(std::move(path)), reading_(&reading) {}

  [[nodiscard]] Section sub(std::string_view key) {
    own_keys_.push_back(key);
    return {table_.table(key), path_ + std::string(key) + ".", *reading_};
  }
  /// The tables of `[[key]]`, in the file's order. Their keys go to @p reading: not every file has
  /// them.
  [[nodiscard]] std::vector<Section> subs(std::string_view key, ConfigReading& reading) {
    own_keys_.push_back(key);
    std::vector<Section> found;
    for (TomlTable& table : table_.tables(key))
      found.push_back({std::move(table), path_ + std::string(key) + ".", reading});
    return found;
  }

  void text(std::string_view key, std::string& value) { value = named(key).textOr(key, value); }
  /// A text that must not be empty.
  void word(std::string_view key, std::string& value) {
    text(key, value);
    if (value.empty()) fail(key, std::string(key) + " must not be empty");
  }
  void texts(std::string_view key, std::vector<std::string>& value) {
    value = named(key).textsOr(key, value);
  }
  void flag(std::string_view key, bool& value) { value = named(key).flagOr(key, value); }
  void number(std::string_view key, double& value, const NumberRange& range) {
    value = named(key).numberOr(key, value, range);
  }
  /// A number, or @p word for none.
  void numberOrWord(std::string_view key, std::optional<double>& value, const NumberRange& range,
                    std::string_view word) {
    const TomlTable& table = named(key);
    if (table.isText(key) && table.text(key) == word) {
      value.reset();
    } else if (table.isText(key)) {
      fail(key, std::string(key) + " must be a number or \"" + std::string(word) + "\", not \"" +
                    table.text(key) + "\"");
    } else if (table.has(key)) {
      value = table.number(key, range);
    }
  }
  void numbers(std::string_view key, std::vector<double>& value, const NumberRange& range) {
    value = named(key).numberListOr(key, value, range);
  }
  void integer(std::string_view key, std::uint32_t& value, const IntegerRange& range) {
    value = static_cast<std::uint32_t>(named(key).integerOr(key, value, range));
  }
  void integer(std::string_view key, int& value, const IntegerRange& range) {
    value = static_cast<int>(named(key).integerOr(key, value, range));
  }
  /// A key in whole milliseconds.
  void milliseconds(std::string_view key, std::chrono::milliseconds& value,
                    const IntegerRange& range) {
    value = std::chrono::milliseconds(named(key).integerOr(key, value.count(), range));
  }
  /// A key in milliseconds and parts of them.
  void milliseconds(std::string_view key, rt::Nanoseconds& value, const NumberRange& range) {
    const double ms = std::chrono::duration<double, std::milli>(value).count();
    value = rt::Nanoseconds(std::llround(named(key).numberOr(key, ms, range) * 1e6));
  }
  /// One of the names in @p choices, in the order of the values of the enumeration.
  template <class Enum, std::size_t N>
  void choice(std::string_view key, Enum& value, const std::array<std::string_view, N>& choices) {
    const std::string name = named(key).textOr(key, choices[static_cast<std::size_t>(value)]);
    const auto* found = std::ranges::find(choices, name);
    if (found != choices.end()) {
      value = static_cast<Enum>(found - choices.begin());
      return;
    }
    std::string known;
    for (const std::string_view one : choices) known.append(known.empty() ? "" : ", ").append(one);
    fail(key, std::string(key) + " must be one of " + known + ", not \"" + name + "\"");
  }

  [[nodiscard]] TomlTable& named(std::string_view key) {
    own_keys_.push_back(key);
    reading_->keys.push_back(path_ + std::string(key));
    return table_;
  }
  void fail(std::string_view key, const std::string& message) const { table_.fail(key, message); }

  /// A key of earlier versions: it is accepted without effect, and a warning says so.
  void retired(std::string_view key, const char* because) {
    own_keys_.push_back(key);
    if (!table_.has(key)) return;
    reading_->warnings.push_back(path_ + std::string(key) + " has no effect any more (" + because +
                                 "): remove it from the configuration");
  }

  /// After the last key: every other one is unknown.
  void end() const {
    reading_->typed ? table_.allowKeys(own_keys_) : table_.warnUnknownKeys(own_keys_);
  }

 private:
  TomlTable table_;
  std::string path_;
  ConfigReading* reading_;
  std::vector<std::string_view> own_keys_;
};

}  // namespace appliance
