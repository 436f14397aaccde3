#include "appliance/words/phrase.h"

#include <algorithm>
#include <cstdio>

namespace appliance {
namespace {

constexpr std::size_t kLongestId = 40;

/// "kCameraSilent" as "camera-silent".
struct Id {
  std::array<char, kLongestId> letters{};
  std::size_t length = 0;
};

constexpr Id idFrom(std::string_view identifier) {
  Id id;
  for (const char letter : identifier.substr(1)) {
    const bool upper = letter >= 'A' && letter <= 'Z';
    if (upper && id.length > 0) id.letters[id.length++] = '-';
    id.letters[id.length++] = upper ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return id;
}

constexpr auto kIds = [] {
  std::array<Id, words::kTable.size()> ids{};
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = idFrom(words::kTable[i].identifier);
  return ids;
}();

std::string_view textArgument(const Phrase& phrase, std::size_t index) {
  std::string_view rest(phrase.texts.data(), phrase.texts.size());
  for (; index > 0 && !rest.empty(); --index)
    rest.remove_prefix(std::min(rest.find('\0'), rest.size() - 1) + 1);
  return rest.substr(0, rest.find('\0'));
}

std::string numberText(double number, const words::Placeholder& how) {
  std::array<char, 48> text{};
  const int length = how.kind == words::Placeholder::Kind::kShortest
                         ? std::snprintf(text.data(), text.size(), "%.*g", how.digits, number)
                         : std::snprintf(text.data(), text.size(), "%.*f", how.digits, number);
  const auto used = static_cast<std::size_t>(length);
  return {text.data(), std::min(used, text.size() - 1)};
}

}  // namespace

std::string_view idOf(Word word) {
  const Id& id = kIds[static_cast<std::size_t>(word)];
  return {id.letters.data(), id.length};
}

std::string textOf(const Phrase& phrase) {
  return words::formatted(englishOf(phrase.word), phrase);
}

std::string withId(Word word, const std::string& text) {
  if (word == Word::kNothing || text.starts_with('[')) return text;
  return "[" + std::string(idOf(word)) + "] " + text;
}

std::string withId(const Phrase& phrase) {
  return withId(phrase.word, textOf(phrase));
}

namespace words {

std::string formatted(std::string_view pattern, const Phrase& phrase) {
  const auto arguments = argumentsOf(englishOf(phrase.word));
  std::string text;
  while (!pattern.empty()) {
    const auto piece = takePiece(pattern);
    if (!piece) break;
    text += piece->literal;
    if (!piece->placeholder || !arguments) continue;
    std::size_t numbers = 0;  // before the argument, in the English order
    std::size_t texts = 0;
    for (std::size_t i = 0; i < arguments->count; ++i) {
      const Placeholder& argument = arguments->all[i];
      if (argument.name == piece->placeholder->name) {
        text += argument.isText() ? std::string(textArgument(phrase, texts))
                                  : numberText(phrase.numbers[numbers], *piece->placeholder);
        break;
      }
      ++(argument.isText() ? texts : numbers);
    }
  }
  return text;
}

}  // namespace words

}  // namespace appliance
