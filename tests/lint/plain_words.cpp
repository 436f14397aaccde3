#include "tests/lint/plain_words.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace lint {

std::vector<std::string> hardWordsIn(std::string_view text) {
  static const std::regex kHard(
      R"((told|tells?|telling|anew|afresh|at once|for ever|somebody|nobody|whoever|whom|wish(es)?|)"
      R"(brings?|brought|as asked|be had|nothing but|lest|thereby|hence|whence|ere|upon|so be it|)"
      R"(for certain|in the midst))",
      std::regex::icase);
  const auto joined = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '-';
  };
  std::vector<std::string> found;
  const std::string copy(text);
  for (auto it = std::sregex_iterator(copy.begin(), copy.end(), kHard);
       it != std::sregex_iterator(); ++it) {
    const auto begin = static_cast<std::size_t>(it->position());
    const std::size_t end = begin + static_cast<std::size_t>(it->length());
    if (begin > 0 && joined(copy[begin - 1])) continue;  // a part of a name or of a longer word
    if (end < copy.size() && joined(copy[end])) continue;
    std::string word = it->str();
    std::ranges::transform(word, word.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    found.push_back(std::move(word));
  }
  return found;
}

std::string proseOf(const SourceFile& file, const std::string& line) {
  if (!file.path.ends_with(".h") && !file.path.ends_with(".cpp")) return line;
  static const std::regex kLiteral(R"re("(\\.|[^"\\])*")re");
  const std::size_t comment = std::min(line.find("//"), line.size());
  std::string prose = line.substr(comment);
  const std::string code = line.substr(0, comment);
  for (auto it = std::sregex_iterator(code.begin(), code.end(), kLiteral);
       it != std::sregex_iterator(); ++it)
    prose += " " + it->str();
  return prose;
}

}  // namespace lint
