#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace appliance {

class TomlTable;

/// What a number may be; both ends belong to it. The unit is for the message only.
struct NumberRange {
  double lowest = std::numeric_limits<double>::lowest();
  double highest = std::numeric_limits<double>::max();
  const char* unit = "";
};
struct IntegerRange {
  std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
  std::int64_t highest = std::numeric_limits<std::int64_t>::max();
  const char* unit = "";
};

/// The word of @p known with the smallest edit distance, if it is near enough to be a
/// slip of the finger: at most a third of the word, at least one letter.
[[nodiscard]] std::optional<std::string_view> closestWord(std::string_view word,
                                                          std::span<const std::string_view> known);

/// A TOML file that is read strictly: what is missing or out of range is an error with file and
/// line, never a silent default. The reader decides whether an unknown key is an error or a
/// warning.
///
/// Read every value first and call fault() once at the end: a getter that fails notes the first
/// fault and returns a harmless value.
///
///   auto file = TomlFile::load("rig.toml");
///   if (!file) return std::unexpected(file.error());
///   TomlTable root = file->root();
///   root.allowKeys({"name", "width_px"});
///   const std::string name = root.text("name");
///   const auto width_px = root.integerOr("width_px", 1280, {1, 16384, "px"});
///   if (file->fault()) return std::unexpected(*file->fault());
///
/// Threads  One thread at a time for a file and its tables.
/// RT       Not RT safe.
/// Memory   Tables borrow from their file, which may be moved but must outlive them.
/// Errors   One line each: `FILE:LINE: [table: ]what is wrong; what to do`. Nothing throws.
class TomlFile {
 public:
  [[nodiscard]] static std::expected<TomlFile, std::string> load(const std::string& path);
  /// The same from memory; @p name stands in messages in place of a path.
  [[nodiscard]] static std::expected<TomlFile, std::string> parse(std::string_view text,
                                                                  std::string name);
  TomlFile(TomlFile&& other) noexcept;
  TomlFile& operator=(TomlFile&& other) noexcept;
  ~TomlFile();

  [[nodiscard]] TomlTable root() const;
  /// The first thing found wrong since parsing, as one line.
  [[nodiscard]] const std::optional<std::string>& fault() const;
  /// What was ignored since parsing, one line each: `FILE:LINE: [table: ]unknown key ...`.
  [[nodiscard]] const std::vector<std::string>& warnings() const;

 private:
  friend class TomlTable;
  struct Content;  // keeps toml++ out of every includer
  explicit TomlFile(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// One table of a TomlFile. Getters without `Or` demand the key; with `Or` an absent key
/// gives the fallback. A present but wrong value is a fault in both. Copies are cheap.
class TomlTable {
 public:
  /// How messages name this table, e.g. `camera "cam03"`; until then its path in the file.
  void setLabel(std::string label) { label_ = std::move(label); }

  /// Every other key is a fault, with the closest of @p keys as the suggestion.
  void allowKeys(std::span<const std::string_view> keys) const;
  void allowKeys(std::initializer_list<std::string_view> keys) const {
    allowKeys(std::span(keys.begin(), keys.size()));
  }
  /// Every other key is ignored with a warning: a file of a newer version still starts the box.
  void warnUnknownKeys(std::span<const std::string_view> keys) const;
  void warnUnknownKeys(std::initializer_list<std::string_view> keys) const {
    warnUnknownKeys(std::span(keys.begin(), keys.size()));
  }

  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] bool isText(std::string_view key) const;
  [[nodiscard]] std::string text(std::string_view key) const;
  [[nodiscard]] std::string textOr(std::string_view key, std::string_view fallback) const;
  [[nodiscard]] bool flagOr(std::string_view key, bool fallback) const;
  /// Takes 3 as well as 3.0; never infinite, never not-a-number.
  [[nodiscard]] double number(std::string_view key, const NumberRange& range = {}) const;
  [[nodiscard]] double numberOr(std::string_view key, double fallback,
                                const NumberRange& range = {}) const;
  [[nodiscard]] std::int64_t integer(std::string_view key, const IntegerRange& range = {}) const;
  [[nodiscard]] std::int64_t integerOr(std::string_view key, std::int64_t fallback,
                                       const IntegerRange& range = {}) const;
  /// An array of exactly @p count finite numbers; zeros after a fault.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count,
                                            const NumberRange& range = {}) const;
  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(std::string_view key,
                                              const NumberRange& range = {}) const {
    std::array<double, N> out{};
    const std::vector<double> read = numbers(key, N, range);
    for (std::size_t i = 0; i < N; ++i) out[i] = read[i];
    return out;
  }
  /// Arrays of any length.
  [[nodiscard]] std::vector<double> numberListOr(std::string_view key, std::vector<double> fallback,
                                                 const NumberRange& range = {}) const;
  [[nodiscard]] std::vector<std::int64_t> integerListOr(std::string_view key,
                                                        std::vector<std::int64_t> fallback,
                                                        const IntegerRange& range = {}) const;
  /// @p rows arrays of @p columns finite numbers, row-major; zeros after a fault.
  [[nodiscard]] std::vector<double> matrix(std::string_view key, std::size_t rows,
                                           std::size_t columns,
                                           const NumberRange& range = {}) const;
  [[nodiscard]] std::vector<std::string> textsOr(std::string_view key,
                                                 std::vector<std::string> fallback) const;

  /// `[key]`; an absent one reads as an empty table, so that defaults need no second path.
  [[nodiscard]] TomlTable table(std::string_view key) const;
  /// `[[key]]`, in file order; empty when absent.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key) const;

  /// Notes a fault found by the caller, at the line of @p key (of the table when absent).
  void fail(std::string_view key, const std::string& message) const;
  /// The same as a warning: reading goes on.
  void warn(std::string_view key, const std::string& message) const;

 private:
  friend class TomlFile;
  struct Access;  // reaches the toml++ node behind node_
  TomlTable(TomlFile::Content* content, const void* node, std::uint32_t line, std::string label);

  TomlFile::Content* content_;
  const void* node_;    // toml::table, null when the table is absent
  std::uint32_t line_;  // of its header; 1 for the root
  std::string label_;
};

}  // namespace appliance
