#include "appliance/config/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <toml++/toml.h>

#include "appliance/config/text_file.h"
#include "appliance/config/toml_text.h"
#include "rt/printable.h"

namespace appliance {
namespace {

/// A file of another program would fill the journal.
constexpr std::size_t kMostWarnings = 32;

std::uint32_t lineOf(const toml::node& node, std::uint32_t otherwise) {
  const std::uint32_t line = node.source().begin.line;
  return line != 0 ? line : otherwise;
}

}  // namespace

struct TomlFile::Content {
  std::string name;
  toml::table root;
  std::optional<std::string> fault;
  std::vector<std::string> warnings;

  [[nodiscard]] std::string lineFor(std::uint32_t line, const std::string& label,
                                    const std::string& message) const {
    return rt::printable(name + ":" + std::to_string(line) + ": " +
                         (label.empty() ? "" : label + ": ") + message);
  }

  void note(std::uint32_t line, const std::string& label, const std::string& message) {
    if (fault) return;  // the first one is the cause, later ones may follow from it
    fault = lineFor(line, label, message);
  }

  void warn(std::uint32_t line, const std::string& label, const std::string& message) {
    if (warnings.size() < kMostWarnings) warnings.push_back(lineFor(line, label, message));
  }
};

TomlFile::TomlFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
TomlFile::TomlFile(TomlFile&& other) noexcept = default;
TomlFile& TomlFile::operator=(TomlFile&& other) noexcept = default;
TomlFile::~TomlFile() = default;

std::expected<TomlFile, std::string> TomlFile::load(const std::string& path) {
  const auto text = readTextFile(path);
  if (!text) return std::unexpected(text.error());
  return parse(*text, path);
}

std::expected<TomlFile, std::string> TomlFile::parse(std::string_view text, std::string name) {
  auto content = std::make_unique<Content>();
  content->name = std::move(name);
  try {
    content->root = toml::parse(text, content->name);
  } catch (const toml::parse_error& error) {
    return std::unexpected(content->name + ":" + std::to_string(error.source().begin.line) +
                           ": not valid TOML: " + rt::printable(error.description()) +
                           "; correct this line");
  }
  return TomlFile(std::move(content));
}

TomlTable TomlFile::root() const {
  return {content_.get(), &content_->root, 1, ""};
}

const std::optional<std::string>& TomlFile::fault() const {
  return content_->fault;
}

const std::vector<std::string>& TomlFile::warnings() const {
  return content_->warnings;
}

/// The typed side of a table: kept here so that the header names no toml++ type.
struct TomlTable::Access {
  static const toml::node* find(const TomlTable& t, std::string_view key) {
    return t.node_ != nullptr ? static_cast<const toml::table*>(t.node_)->get(key) : nullptr;
  }

  static const toml::node* demand(const TomlTable& t, std::string_view key) {
    const toml::node* node = find(t, key);
    if (node == nullptr)
      t.content_->note(t.line_, t.label_,
                       "the key \"" + std::string(key) + "\" is missing; add it");
    return node;
  }

  static void note(const TomlTable& t, const toml::node& node, const std::string& message) {
    t.content_->note(lineOf(node, t.line_), t.label_, message);
  }

  static void noteKind(const TomlTable& t, const toml::node& node, std::string_view key,
                       const std::string& expected) {
    note(t, node, std::string(key) + " must be " + expected + ", not " + kindOf(node));
  }

  static std::string readText(const TomlTable& t, const toml::node& node, std::string_view key) {
    if (const auto* text = node.as_string()) return text->get();
    noteKind(t, node, key, "text in quotes");
    return {};
  }

  static std::optional<double> readNumber(const TomlTable& t, const toml::node& node,
                                          const std::string& what, const NumberRange& range) {
    double value = 0;
    if (const auto* real = node.as_floating_point()) {
      value = real->get();
    } else if (const auto* whole = node.as_integer()) {
      value = static_cast<double>(whole->get());
    } else {
      noteKind(t, node, what,
               "a number" + (*range.unit != '\0' ? " in " + std::string(range.unit) : ""));
      return std::nullopt;
    }
    if (!std::isfinite(value)) {
      note(t, node, what + " must be a finite number, not " + numberText(value));
      return std::nullopt;
    }
    if (value < range.lowest || value > range.highest) {
      note(t, node, what + " must be " + rangeText(range) + ", not " + numberText(value));
      return std::nullopt;
    }
    return value;
  }

  static std::optional<std::int64_t> readInteger(const TomlTable& t, const toml::node& node,
                                                 const std::string& key,
                                                 const IntegerRange& range) {
    const auto* whole = node.as_integer();
    if (whole == nullptr) {
      noteKind(t, node, key,
               "a whole number" + (*range.unit != '\0' ? " in " + std::string(range.unit) : ""));
      return std::nullopt;
    }
    const std::int64_t value = whole->get();
    if (value < range.lowest || value > range.highest) {
      note(t, node, key + " must be " + rangeText(range) + ", not " + std::to_string(value));
      return std::nullopt;
    }
    return value;
  }

  /// The elements of @p node, each read by @p read_one; @p fallback after a fault.
  template <class T, class Range>
  static std::vector<T> readList(const TomlTable& t, const toml::node& node, std::string_view key,
                                 std::vector<T> fallback, const Range& range,
                                 std::optional<T> (*read_one)(const TomlTable&, const toml::node&,
                                                              const std::string&, const Range&)) {
    const auto* array = node.as_array();
    if (array == nullptr) {
      noteKind(t, node, key, "an array of numbers");
      return fallback;
    }
    std::vector<T> out;
    for (std::size_t i = 0; i < array->size(); ++i) {
      const std::string what = std::string(key) + "[" + std::to_string(i) + "]";
      const auto value = read_one(t, *array->get(i), what, range);
      if (!value) return fallback;
      out.push_back(*value);
    }
    return out;
  }

  /// Appends @p count numbers of @p node to @p out; false after a fault.
  static bool readNumbers(const TomlTable& t, const toml::node& node, const std::string& what,
                          std::size_t count, const NumberRange& range, std::vector<double>& out) {
    const auto* array = node.as_array();
    if (array == nullptr || array->size() != count) {
      noteKind(t, node, what, "an array of " + std::to_string(count) + " numbers");
      return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = readNumber(t, *array->get(i), what + "[" + std::to_string(i) + "]", range);
      if (!value) return false;
      out.push_back(*value);
    }
    return true;
  }

  /// Reports every key that is not one of @p keys, as (line, message).
  template <class Report>
  static void eachUnknown(const TomlTable& t, std::span<const std::string_view> keys,
                          const std::string& otherwise, Report report);

  static TomlTable child(const TomlTable& t, std::string_view key, const toml::table* table) {
    const std::string path = "[" + std::string(key) + "]";
    return {t.content_, table, table != nullptr ? lineOf(*table, t.line_) : t.line_,
            t.label_.empty() ? path : t.label_ + " " + path};
  }
};

TomlTable::TomlTable(TomlFile::Content* content, const void* node, std::uint32_t line,
                     std::string label)
    : content_(content), node_(node), line_(line), label_(std::move(label)) {}

template <class Report>
void TomlTable::Access::eachUnknown(const TomlTable& t, std::span<const std::string_view> keys,
                                    const std::string& otherwise, Report report) {
  if (t.node_ == nullptr) return;
  for (const auto& [key, node] : *static_cast<const toml::table*>(t.node_)) {
    if (std::ranges::find(keys, key.str()) != keys.end()) continue;
    const auto line = key.source().begin.line;
    std::string message = "unknown key \"" + std::string(key.str()) + "\"; ";
    if (const auto suggestion = closestWord(key.str(), keys)) {
      message += "did you mean \"" + std::string(*suggestion) + "\"?";
    } else {
      message += otherwise;
    }
    report(line != 0 ? line : t.line_, message);
  }
}

void TomlTable::allowKeys(std::span<const std::string_view> keys) const {
  Access::eachUnknown(*this, keys, "remove it, or see the manual for the keys that exist",
                      [this](std::uint32_t line, const std::string& message) {
                        content_->note(line, label_, message);
                      });
}

void TomlTable::warnUnknownKeys(std::span<const std::string_view> keys) const {
  Access::eachUnknown(*this, keys, "it is ignored; another version may know it",
                      [this](std::uint32_t line, const std::string& message) {
                        content_->warn(line, label_, message);
                      });
}

bool TomlTable::has(std::string_view key) const {
  return Access::find(*this, key) != nullptr;
}

bool TomlTable::isText(std::string_view key) const {
  const toml::node* node = Access::find(*this, key);
  return node != nullptr && node->is_string();
}

std::string TomlTable::text(std::string_view key) const {
  const toml::node* node = Access::demand(*this, key);
  return node != nullptr ? Access::readText(*this, *node, key) : std::string();
}

std::string TomlTable::textOr(std::string_view key, std::string_view fallback) const {
  return has(key) ? text(key) : std::string(fallback);
}

bool TomlTable::flagOr(std::string_view key, bool fallback) const {
  const toml::node* node = Access::find(*this, key);
  if (node == nullptr) return fallback;
  if (const auto* flag = node->as_boolean()) return flag->get();
  Access::noteKind(*this, *node, key, "true or false");
  return fallback;
}

double TomlTable::number(std::string_view key, const NumberRange& range) const {
  const toml::node* node = Access::demand(*this, key);
  return node != nullptr ? Access::readNumber(*this, *node, std::string(key), range).value_or(0)
                         : 0;
}

double TomlTable::numberOr(std::string_view key, double fallback, const NumberRange& range) const {
  return has(key) ? number(key, range) : fallback;
}

std::int64_t TomlTable::integer(std::string_view key, const IntegerRange& range) const {
  const toml::node* node = Access::demand(*this, key);
  return node != nullptr ? Access::readInteger(*this, *node, std::string(key), range).value_or(0)
                         : 0;
}

std::int64_t TomlTable::integerOr(std::string_view key, std::int64_t fallback,
                                  const IntegerRange& range) const {
  return has(key) ? integer(key, range) : fallback;
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count,
                                       const NumberRange& range) const {
  std::vector<double> out;
  const toml::node* node = Access::demand(*this, key);
  if (node == nullptr || !Access::readNumbers(*this, *node, std::string(key), count, range, out))
    out.assign(count, 0);
  return out;
}

std::vector<double> TomlTable::numberListOr(std::string_view key, std::vector<double> fallback,
                                            const NumberRange& range) const {
  const toml::node* node = Access::find(*this, key);
  if (node == nullptr) return fallback;
  return Access::readList(*this, *node, key, std::move(fallback), range, &Access::readNumber);
}

std::vector<std::int64_t> TomlTable::integerListOr(std::string_view key,
                                                   std::vector<std::int64_t> fallback,
                                                   const IntegerRange& range) const {
  const toml::node* node = Access::find(*this, key);
  if (node == nullptr) return fallback;
  return Access::readList(*this, *node, key, std::move(fallback), range, &Access::readInteger);
}

std::vector<double> TomlTable::matrix(std::string_view key, std::size_t rows, std::size_t columns,
                                      const NumberRange& range) const {
  std::vector<double> zeros(rows * columns, 0);
  const toml::node* node = Access::demand(*this, key);
  if (node == nullptr) return zeros;
  const auto* array = node->as_array();
  if (array == nullptr || array->size() != rows) {
    Access::noteKind(
        *this, *node, key,
        "an array of " + std::to_string(rows) + " rows of " + std::to_string(columns) + " numbers");
    return zeros;
  }
  std::vector<double> out;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::string what = std::string(key) + "[" + std::to_string(row) + "]";
    if (!Access::readNumbers(*this, *array->get(row), what, columns, range, out)) return zeros;
  }
  return out;
}

std::vector<std::string> TomlTable::textsOr(std::string_view key,
                                            std::vector<std::string> fallback) const {
  const toml::node* node = Access::find(*this, key);
  if (node == nullptr) return fallback;
  const auto* array = node->as_array();
  if (array == nullptr) {
    Access::noteKind(*this, *node, key, "an array of texts");
    return fallback;
  }
  std::vector<std::string> out;
  for (const toml::node& element : *array) out.push_back(Access::readText(*this, element, key));
  return out;
}

TomlTable TomlTable::table(std::string_view key) const {
  const toml::node* node = Access::find(*this, key);
  if (node == nullptr) return Access::child(*this, key, nullptr);
  if (!node->is_table()) Access::noteKind(*this, *node, key, "a table, [" + std::string(key) + "]");
  return Access::child(*this, key, node->as_table());
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  std::vector<TomlTable> out;
  const toml::node* node = Access::find(*this, key);
  if (node == nullptr) return out;
  const auto* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    Access::noteKind(*this, *node, key, "a list of tables, [[" + std::string(key) + "]]");
    return out;
  }
  for (const toml::node& element : *array) {
    out.push_back(Access::child(*this, key, element.as_table()));
  }
  return out;
}

void TomlTable::fail(std::string_view key, const std::string& message) const {
  const toml::node* node = Access::find(*this, key);
  content_->note(node != nullptr ? lineOf(*node, line_) : line_, label_, message);
}

void TomlTable::warn(std::string_view key, const std::string& message) const {
  const toml::node* node = Access::find(*this, key);
  content_->warn(node != nullptr ? lineOf(*node, line_) : line_, label_, message);
}

}  // namespace appliance
