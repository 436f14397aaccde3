#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/source_tree.h"

namespace {

using lint::SourceFile;

/// Words that bind the tree to one machine or leave work undone. Written in two halves, so that
/// this file is not its own finding.
const std::vector<std::string>& forbiddenWords() {
  static const std::vector<std::string> kWords = {
      std::string("/wo") + "rk/",  // folders of one machine
      std::string("/ho") + "me/",
      std::string("/var/tmp/") + "roots",
      std::string("deb.debian") + ".org",  // sources are the machine's own
      std::string("registry.npmjs") + ".org",
      std::string("TO") + "DO",  // an issue, or nothing
      std::string("FIX") + "ME",
  };
  return kWords;
}

std::vector<std::string> forbiddenWordsIn(const SourceFile& file) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    for (const auto& word : forbiddenWords()) {
      if (file.lines[i].find(word) != std::string::npos) {
        found.push_back(file.path + ":" + std::to_string(i + 1) + ": '" + word + "'");
      }
    }
  }
  return found;
}

TEST(ForbiddenWords, AreFoundWithFileAndLine) {
  const SourceFile file{.path = "a.md", .lines = {"fine", "see " + forbiddenWords().front() + "x"}};
  EXPECT_THAT(forbiddenWordsIn(file),
              testing::ElementsAre("a.md:2: '" + forbiddenWords().front() + "'"));
}

TEST(Tree, NamesNoMachineNoHostAndNoUnfinishedWork) {
  const auto files = lint::readTree(lint::root());
  ASSERT_GT(files.size(), 20u) << "no project under " << lint::root();
  for (const auto& file : files) {
    for (const auto& line : forbiddenWordsIn(file)) ADD_FAILURE() << line;
  }
}

/// A guide and an end: past the first a file is named, past the second it must be split.
TEST(Tree, KeepsFilesSmallEnoughToReadAtOnce) {
  for (const auto& file : lint::cppFilesOf(lint::readTree(lint::root()))) {
    const bool header = file.path.ends_with(".h");
    const std::size_t guide = header ? 200 : 400;
    if (file.lines.size() > guide) {
      std::printf("warning: %s has %zu lines, the guide is %zu\n", file.path.c_str(),
                  file.lines.size(), guide);
    }
    EXPECT_LE(file.lines.size(), 2 * guide) << file.path << ": split it";
  }
}

}  // namespace
