#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace appliance::words {

/// A placeholder of a pattern: {name}, {name:d}, {name:g} or {name:.2}.
struct Placeholder {
  enum class Kind : std::uint8_t { kText, kWhole, kShortest, kDecimals };

  std::string_view name;
  Kind kind = Kind::kText;
  int decimals = 0;  ///< of kDecimals

  [[nodiscard]] constexpr bool isText() const { return kind == Kind::kText; }
};

inline constexpr std::size_t kMostArguments = 4;

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
  const std::string_view format = inside.substr(colon + 1);
  if (format == "d") {
    found.kind = Placeholder::Kind::kWhole;
  } else if (format == "g") {
    found.kind = Placeholder::Kind::kShortest;
  } else if (format.size() == 2 && format[0] == '.' && format[1] >= '1' && format[1] <= '9') {
    found.kind = Placeholder::Kind::kDecimals;
    found.decimals = format[1] - '0';
  } else {
    return std::nullopt;
  }
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
