#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/source_tree.h"

namespace {

namespace fs = std::filesystem;
using lint::SourceFile;

/// The targets of a page's links and pictures that are files of ours, from the root.
std::vector<std::string> linksOf(const SourceFile& page) {
  static const std::regex kLink(R"(\]\(([^)#\s]+)[^)]*\))");
  const auto folder = fs::path(page.path).parent_path();
  std::vector<std::string> links;
  for (const auto& line : page.lines) {
    for (std::sregex_iterator it(line.begin(), line.end(), kLink), end; it != end; ++it) {
      const std::string target = (*it)[1];
      if (target.find("://") != std::string::npos) continue;
      links.push_back((folder / target).lexically_normal().generic_string());
    }
  }
  return links;
}

TEST(Links, AreReadRelativeToTheirPage) {
  EXPECT_THAT(linksOf({.path = "docs/a.md",
                       .lines = {"see [b](b.md#part) and ![c](../c.png)", "[d](https://d/e)"}}),
              testing::ElementsAre("docs/b.md", "c.png"));
}

TEST(Tree, HasEveryFileThatAPageLinksTo) {
  std::size_t links = 0;
  for (const auto& file : lint::readTree(lint::root())) {
    if (!file.path.ends_with(".md")) continue;
    for (const auto& link : linksOf(file)) {
      ++links;
      EXPECT_TRUE(fs::exists(lint::root() / link)) << file.path << " links to " << link;
    }
  }
  EXPECT_GT(links, 0u);
}

}  // namespace
