#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace appliance::words {

/// A placeholder of a pattern: {name}, {name:d}, {name:g}, {name:g4} or {name:.2}.
struct Placeholder {
  enum class Kind : std::uint8_t { kText, kWhole, kShortest, kDecimals };

  std::string_view name;
  Kind kind = Kind::kText;
  int digits = 0;  ///< kDecimals: after the point; kShortest: in all

  [[nodiscard]] constexpr bool isText() const { return kind == Kind::kText; }
};

inline constexpr std::size_t kMostArguments = 8;
inline constexpr int kShortestDigits = 6;  ///< of {name:g}

/// Reads the format of a placeholder, "d" or ".2". False if there is no such format.
constexpr bool readFormat(std::string_view format, Placeholder& to) {
  const bool has_digit = format.size() == 2 && format[1] >= '1' && format[1] <= '9';
  if (format == "d") {
    to.kind = Placeholder::Kind::kWhole;
  } else if (format == "g") {
    to.kind = Placeholder::Kind::kShortest;
    to.digits = kShortestDigits;
  } else if (has_digit && (format[0] == '.' || format[0] == 'g')) {
    to.kind = format[0] == '.' ? Placeholder::Kind::kDecimals : Placeholder::Kind::kShortest;
    to.digits = format[1] - '0';
  } else {
    return false;
  }
  return true;
}

/// The arguments of a pattern, each name once, in the order in which they first appear.
struct Arguments {
  std::array<Placeholder, kMostArguments> all{};
  std::size_t count = 0;

  [[nodiscard]] constexpr const Placeholder* find(std::string_view name) const {
    for (std::size_t i = 0; i < count; ++i)
      if (all[i].name == name) return &all[i];
    return nullptr;
  }
};

/// One piece of a pattern: literal text, or a placeholder.
struct Piece {
  std::string_view literal;
  std::optional<Placeholder> placeholder;
};

/// Takes the first piece off @p rest; nothing if a brace or a format is wrong.
constexpr std::optional<Piece> takePiece(std::string_view& rest) {
  if (rest.empty() || rest.front() == '}') return std::nullopt;
  if (rest.front() != '{') {
    const std::size_t end = std::min(rest.find_first_of("{}"), rest.size());
    const Piece piece{.literal = rest.substr(0, end), .placeholder = {}};
    rest.remove_prefix(end);
    return piece;
  }
  const std::size_t end = rest.find('}');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view inside = rest.substr(1, end - 1);
  rest.remove_prefix(end + 1);
  const std::size_t colon = std::min(inside.find(':'), inside.size());
  Placeholder found{.name = inside.substr(0, colon)};
  if (found.name.empty()) return std::nullopt;
  if (colon == inside.size()) return Piece{.literal = {}, .placeholder = found};
  if (!readFormat(inside.substr(colon + 1), found)) return std::nullopt;
  return Piece{.literal = {}, .placeholder = found};
}

/// Nothing if the pattern is malformed, has too many arguments, or formats one in two ways.
constexpr std::optional<Arguments> argumentsOf(std::string_view pattern) {
  Arguments arguments;
  while (!pattern.empty()) {
    const auto piece = takePiece(pattern);
    if (!piece) return std::nullopt;
    if (!piece->placeholder) continue;
    if (const Placeholder* known = arguments.find(piece->placeholder->name)) {
      if (known->isText() != piece->placeholder->isText()) return std::nullopt;
      continue;
    }
    if (arguments.count == kMostArguments) return std::nullopt;
    arguments.all[arguments.count++] = *piece->placeholder;
  }
  return arguments;
}

}  // namespace appliance::words
