// Comments, pages and messages are written in words that are read once (HACKING.md, "Style").

#include "tests/lint/plain_words.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/source_tree.h"

namespace {

using lint::hardWordsIn;
using lint::proseOf;
using lint::SourceFile;
using testing::ElementsAre;
using testing::IsEmpty;

/// Texts of others, inputs of fuzz targets, and the list itself.
bool isOurs(const std::string& path) {
  return path != "LICENSE" && path.find("/corpus/") == std::string::npos &&
         !path.ends_with(".patch") && !path.starts_with("tests/lint/plain_words");
}

TEST(PlainWords, FindsWholeWordsOfEitherCase) {
  EXPECT_THAT(hardWordsIn("Nobody drew it anew, at once."),
              ElementsAre("nobody", "anew", "at once"));
  EXPECT_THAT(hardWordsIn("whenever there is a canewood, at_once or tell-tale"), IsEmpty());
}

TEST(PlainWords, ReadsCommentsAndLiteralsOfCode) {
  const SourceFile code{.path = "a.cpp", .lines = {}};
  EXPECT_EQ(proseOf(code, "int told = f(\"say\");  // why"), "// why \"say\"");
  const SourceFile page{.path = "a.md", .lines = {}};
  EXPECT_EQ(proseOf(page, "as it stands"), "as it stands");
}

TEST(PlainWords, AreTheOnlyOnesInTheTree) {
  for (const SourceFile& file : lint::readTree(lint::root())) {
    if (!isOurs(file.path)) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      for (const std::string& word : hardWordsIn(proseOf(file, file.lines[i])))
        ADD_FAILURE() << file.path << ":" << i + 1 << ": '" << word
                      << "': say it plainly (HACKING.md, \"Style\")";
  }
}

}  // namespace
