#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

#include "appliance/words/pattern.h"
#include "appliance/words/word.h"

namespace appliance {

/// What a person shall read, in no language yet: a word and its arguments. Trivially copyable, so
/// that it may cross threads. The text is made where a person reads it.
///
/// Memory  Fixed size. Text that does not fit is cut between two characters of UTF-8.
struct Phrase {
  static constexpr std::size_t kTextBytes = 400;

  Word word = Word::kNothing;
  std::array<double, words::kMostArguments> numbers{};
  std::array<char, kTextBytes> texts{};  ///< one after the other, each with its zero

  /// There is nothing to say.
  [[nodiscard]] bool empty() const { return word == Word::kNothing; }
  friend bool operator==(const Phrase&, const Phrase&) = default;
};

namespace words {

template <class Argument>
concept Number = std::is_arithmetic_v<Argument>;

template <class Argument>
concept Text = std::convertible_to<const Argument&, std::string_view>;

/// Fills a phrase's arguments in their order.
class PhraseWriter {
 public:
  explicit constexpr PhraseWriter(Phrase& phrase) : phrase_(phrase) {}
  template <Number Argument>
  constexpr void add(const Argument& number) {
    phrase_.numbers[number_++] = static_cast<double>(number);
  }
  template <Text Argument>
  constexpr void add(const Argument& text) {
    addText(text);
  }

 private:
  constexpr void addText(std::string_view text) {
    std::size_t bytes = std::min(text.size(), text_left_ - 1);
    if (bytes < text.size())
      while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) --bytes;
    std::copy_n(text.begin(), bytes, phrase_.texts.end() - static_cast<std::ptrdiff_t>(text_left_));
    text_left_ -= std::min(bytes + 1, text_left_ - 1);
  }

  Phrase& phrase_;
  std::size_t number_ = 0;
  std::size_t text_left_ = Phrase::kTextBytes;
};

template <Word kWord, class... Given>
constexpr bool fits() {
  constexpr auto kArguments = argumentsOf(englishOf(kWord));
  if (!kArguments || kArguments->count != sizeof...(Given)) return false;
  std::size_t i = 0;
  return ((Text<Given> == kArguments->all[i++].isText()) && ...);
}

}  // namespace words

/// phrase<Word::kCameraSilent>(4.0). Number and kinds of the arguments are those of the pattern,
/// or it does not compile.
template <Word kWord, class... Given>
[[nodiscard]] constexpr Phrase phrase(const Given&... given) {
  static_assert(words::fits<kWord, Given...>(), "english.inc has other arguments for this word");
  Phrase made{.word = kWord};
  words::PhraseWriter writer(made);
  (writer.add(given), ...);
  return made;
}

/// The phrase in English, for status, journal and screen.
[[nodiscard]] std::string textOf(const Phrase& phrase);

/// "[history-too-large] the history of 240 sets takes ...": a line of the journal, or an error that
/// becomes one.
[[nodiscard]] std::string withId(const Phrase& phrase);

/// The same for a @p text of another origin, such as a backend's. One that carries an id keeps it.
[[nodiscard]] std::string withId(Word word, const std::string& text);

namespace words {

/// The phrase by another language's @p pattern, whose placeholders may stand in another order.
[[nodiscard]] std::string formatted(std::string_view pattern, const Phrase& phrase);

}  // namespace words

}  // namespace appliance
