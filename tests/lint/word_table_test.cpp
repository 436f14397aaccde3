// The table of words is complete, plain, and the only place of what the ported files say.

#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/words/pattern.h"
#include "appliance/words/word.h"
#include "tests/lint/source_tree.h"

namespace {

using appliance::words::argumentsOf;
using appliance::words::kTable;
using appliance::words::takePiece;
using lint::SourceFile;

/// Files whose sentences have moved to the table. A new file that speaks to people belongs here.
const std::vector<std::string>& portedFiles() {
  static const std::vector<std::string> kFiles = {
      "appliance/capture/camera_array.cpp",      "appliance/capture/camera_state.cpp",
      "appliance/capture/cameras_part.cpp",      "appliance/capture/genlock_text.cpp",
      "appliance/capture/trigger_part.cpp",      "appliance/depth/depth_part.cpp",
      "appliance/depth/depth_text.cpp",          "appliance/director/status_line.cpp",
      "appliance/journal/status_conditions.cpp", "appliance/journal/status_journal.cpp",
      "appliance/panel/panel_part.cpp",
  };
  return kFiles;
}

/// What the pattern says besides its arguments.
std::string literalOf(std::string_view pattern) {
  std::string literal;
  while (!pattern.empty()) {
    const auto piece = takePiece(pattern);
    if (!piece) break;
    literal += piece->literal;
  }
  return literal;
}

/// Three words of a sentence inside one literal, comments aside.
bool speaks(const std::string& line) {
  static const std::regex kSentence(R"re("[^"]*[a-z]{2,} [a-z]{1,} [a-z]{1,}[^"]*")re");
  const std::string code = line.substr(0, line.find("//"));
  return !code.starts_with("#include") && std::regex_search(code, kSentence);
}

TEST(WordTable, HasPatternsThatCanBeFilledIn) {
  for (const auto& word : kTable) EXPECT_TRUE(argumentsOf(word.english)) << word.identifier;
}

TEST(WordTable, SaysEachThingOnce) {
  std::set<std::string_view> patterns;
  for (const auto& word : kTable) {
    if (literalOf(word.english).empty()) continue;  // a backend's own text
    EXPECT_TRUE(patterns.insert(word.english).second) << word.identifier << " repeats another";
  }
}

TEST(WordTable, IsPlain) {
  const std::regex archaic(
      R"(\b(anew|at once|for ever|told|tells?|brings?|brought|nobody|somebody|whoever|wish(es)?|as asked|to be had|wants)\b)");
  for (const auto& word : kTable) {
    const std::string literal = literalOf(word.english);
    EXPECT_FALSE(std::regex_search(literal, archaic)) << word.identifier << ": " << literal;
    EXPECT_LE(std::ranges::count(literal, ':'), 1) << word.identifier << ": " << literal;
    EXPECT_EQ(word.english.find("  "), std::string::npos) << word.identifier;
  }
}

TEST(WordTable, HasNoWordThatNobodySays) {
  std::set<std::string> said;
  const std::regex use(R"(Word::(k[A-Za-z0-9]+))");
  for (const auto& file : lint::cppFilesOf(lint::readTree(lint::root()))) {
    if (!file.path.starts_with("appliance/") || file.path.starts_with("appliance/words/pattern"))
      continue;
    for (const auto& line : file.lines) {
      const std::string code = line.substr(0, line.find("//"));
      for (auto it = std::sregex_iterator(code.begin(), code.end(), use);
           it != std::sregex_iterator(); ++it)
        said.insert((*it)[1]);
    }
  }
  for (const auto& word : kTable)
    EXPECT_TRUE(said.contains(std::string(word.identifier))) << word.identifier << " is never said";
}

TEST(WordTable, IsTheOnlyPlaceOfWhatThePortedFilesSay) {
  for (const auto& path : portedFiles()) {
    const SourceFile file = lint::read(lint::root(), path);
    ASSERT_FALSE(file.lines.empty()) << path;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(speaks(file.lines[i])) << path << ":" << i + 1 << ": " << file.lines[i];
  }
}

TEST(WordTable, FindsSentencesInCodeOnly) {
  EXPECT_TRUE(speaks(R"(  return "check its cable";)"));
  EXPECT_FALSE(speaks(R"(  return phrase<Word::kCameraGaps>();  // "check its cable")"));
  EXPECT_FALSE(speaks(R"(#include "appliance/a b c/d.h")"));
  EXPECT_FALSE(speaks(R"(  return "streaming";)"));
}

}  // namespace
