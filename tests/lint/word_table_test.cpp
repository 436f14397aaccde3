// The table of words is complete, plain, and the only place of what the box says.

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
#include "tests/lint/plain_words.h"
#include "tests/lint/source_tree.h"

namespace {

using appliance::words::argumentsOf;
using appliance::words::kTable;
using appliance::words::takePiece;
using lint::SourceFile;

/// Code of the product that speaks in its own words, and why. Everything else in appliance/ says
/// what it has to say by the table.
const std::vector<std::string>& exemptPlaces() {
  static const std::vector<std::string> kPlaces = {
      "appliance/main.cpp",  // the texts of its options
      "appliance/tools/",    // what a command prints
      "appliance/control/control_client.cpp",
      "appliance/depth/depth_record.cpp",
      "appliance/depth/latency.cpp",
      "appliance/geometry/coverage_text.cpp",
      "appliance/trace/trace_file.cpp",
      "appliance/config/",  // what is wrong in which line of a file: readers serve commands, too
      "appliance/geometry/rig_file.cpp",
      "appliance/network/uplink_text.cpp",
      "_settings.cpp",
      "appliance/geometry/target_track.cpp",  // names of values
  };
  return kPlaces;
}

bool speaksForItself(const std::string& path) {
  return std::ranges::any_of(exemptPlaces(), [&path](const std::string& place) {
    return place.starts_with('_') ? path.ends_with(place) : path.starts_with(place);
  });
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

/// Three words of a sentence inside one literal. Comments, assertions and the texts of options are
/// left out: a person who reads the journal never sees them.
bool speaks(const std::string& line) {
  static const std::regex kSentence(R"re("[^"]*[a-z]{2,} [a-z]{1,} [a-z]{1,}[^"]*")re");
  static const std::regex kNotSaid(R"(^#include|\bassert\(|static_assert|app\.add_|CLI::App)");
  const std::string code = line.substr(0, line.find("//"));
  return !std::regex_search(code, kNotSaid) && std::regex_search(code, kSentence);
}

/// A remark or a line of the journal that is no phrase: it would have no id.
bool hasNoId(const std::string& line) {
  static const std::regex kBare(
      R"re(degraded\.push_back\(\{|remarks?_?\.(add|push_back)\([^;]*"[^"]* [^"]*"\)|\blog\w*\([^;]*")re");
  return std::regex_search(line.substr(0, line.find("//")), kBare);
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
  for (const auto& word : kTable) {
    const std::string literal = literalOf(word.english);
    EXPECT_THAT(lint::hardWordsIn(literal), testing::IsEmpty()) << word.identifier;
    EXPECT_LE(std::ranges::count(literal, ':'), 1) << word.identifier << ": " << literal;
    EXPECT_EQ(word.english.find("  "), std::string::npos) << word.identifier;
  }
}

TEST(WordTable, HasNoUnusedWord) {
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

TEST(WordTable, IsTheOnlyPlaceOfWhatTheBoxSays) {
  for (const auto& file : lint::cppFilesOf(lint::readTree(lint::root()))) {
    if (!file.path.starts_with("appliance/") || file.path.starts_with("appliance/tools/")) continue;
    const bool own_words = speaksForItself(file.path);
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const std::string where = file.path + ":" + std::to_string(i + 1) + ": ";
      EXPECT_FALSE(!own_words && speaks(file.lines[i])) << where << "belongs into english.inc";
      EXPECT_FALSE(hasNoId(file.lines[i])) << where << "has no id, say it by a phrase";
    }
  }
}

TEST(WordTable, ExemptsOnlyPlacesThatExist) {
  const auto files = lint::cppFilesOf(lint::readTree(lint::root()));
  for (const std::string& place : exemptPlaces())
    EXPECT_TRUE(std::ranges::any_of(files, [&place](const SourceFile& file) {
      return file.path.find(place) != std::string::npos;
    })) << place;
}

TEST(WordTable, FindsSentencesInCodeOnly) {
  EXPECT_TRUE(speaks(R"(  return "check its cable";)"));
  EXPECT_FALSE(speaks(R"(  return phrase<Word::kCameraGaps>();  // "check its cable")"));
  EXPECT_FALSE(speaks(R"(#include "appliance/a b c/d.h")"));
  EXPECT_FALSE(speaks(R"(  assert(found && "it is always there");)"));
  EXPECT_FALSE(speaks(R"(  return "streaming";)"));
}

TEST(WordTable, FindsRemarksAndLinesWithoutAnId) {
  EXPECT_TRUE(hasNoId(R"(  status.degraded.push_back({"panel", text});)"));
  EXPECT_TRUE(hasNoId(R"(  remarks.add("memory", "not locked");)"));
  EXPECT_TRUE(hasNoId(R"(  logError("it failed");)"));
  EXPECT_FALSE(hasNoId(R"(  remarks.add("memory", unlocked);)"));
  EXPECT_FALSE(
      hasNoId(R"(  status.degraded.push_back(remarkOf("panel", phrase<Word::kPanelGone>()));)"));
  EXPECT_FALSE(hasNoId(R"(  logError(released.error());)"));
}

}  // namespace
