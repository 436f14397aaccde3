#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/layer_table.h"
#include "tests/lint/source_tree.h"

namespace {

using lint::LayerTable;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

LayerTable smallTable() {
  return LayerTable::fromPage({.path = "docs/page.md",
                               .lines = {
                                   "Text | before.",
                                   "| Folder | May include | Libraries |",
                                   "|---|---|---|",
                                   "| `rt` | - | - |",
                                   "| `hal` | `rt` | - |",
                                   "| `hal/aravis` | `rt` `hal` | `arv.h` |",
                                   "| `appliance` | `rt` `hal` | `Eigen` |",
                                   "| `appliance/main.cpp` | `*` | `*` |",
                                   "",
                               }});
}

TEST(LayerTable, AllowsDownwardsAndWithinAFolder) {
  EXPECT_THAT(smallTable().violations(
                  {.path = "hal/aravis/camera.cpp",
                   .lines = {"#include <arv.h>", "#include <vector>", "#include <sys/mman.h>",
                             "#include \"hal/camera.h\"", "#include \"hal/aravis/profile.h\""}}),
              IsEmpty());
}

TEST(LayerTable, RefusesUpwardsWithFileAndLine) {
  EXPECT_THAT(
      smallTable().violations({.path = "rt/clock.h", .lines = {"", "#include \"hal/camera.h\""}}),
      ElementsAre("rt/clock.h:2: rt may not include hal (hal/camera.h)"));
}

TEST(LayerTable, RefusesABackendInTheApplianceButNotInItsMain) {
  const std::vector<std::string> lines = {"#include \"hal/aravis/camera.h\""};
  EXPECT_THAT(smallTable().violations({.path = "appliance/capture/x.cpp", .lines = lines}),
              ElementsAre(HasSubstr("appliance may not include hal/aravis")));
  EXPECT_THAT(smallTable().violations({.path = "appliance/main.cpp", .lines = lines}), IsEmpty());
}

TEST(LayerTable, AllowsAFolderItsOwnHeaderWithARowAndOthersOnlyIfTheyNameIt) {
  const auto table = LayerTable::fromPage({.path = "docs/page.md",
                                           .lines = {
                                               "| Folder | May include | Libraries |",
                                               "|---|---|---|",
                                               "| `a/value.h` | - | - |",
                                               "| `a` | - | - |",
                                               "| `b` | `a/value.h` | - |",
                                           }});
  const std::vector<std::string> value = {"#include \"a/value.h\""};
  EXPECT_THAT(table.violations({.path = "a/x.cpp", .lines = value}), IsEmpty());
  EXPECT_THAT(table.violations({.path = "b/x.cpp", .lines = value}), IsEmpty());
  EXPECT_THAT(table.violations({.path = "b/x.cpp", .lines = {"#include \"a/x.h\""}}),
              ElementsAre(HasSubstr("b may not include a (a/x.h)")));
  EXPECT_THAT(table.violations({.path = "a/value.h", .lines = {"#include \"a/x.h\""}}),
              ElementsAre(HasSubstr("a/value.h may not include a (a/x.h)")));
}

TEST(LayerTable, TakesEveryFolderUnderAStarForItself) {
  const auto table = LayerTable::fromPage({.path = "docs/page.md",
                                           .lines = {
                                               "| Folder | May include | Libraries |",
                                               "|---|---|---|",
                                               "| `a/box` | - | - |",
                                               "| `a/*` | `a/box` | - |",
                                           }});
  EXPECT_THAT(table.violations({.path = "a/one/x.cpp",
                                .lines = {"#include \"a/one/x.h\"", "#include \"a/box/part.h\""}}),
              IsEmpty());
  EXPECT_THAT(table.violations({.path = "a/one/x.cpp", .lines = {"#include \"a/two/x.h\""}}),
              ElementsAre(HasSubstr("a/one may not include a/two (a/two/x.h)")));
  EXPECT_THAT(table.violations({.path = "a/x.cpp", .lines = {}}), ElementsAre(HasSubstr("no row")));
}

TEST(LayerTable, RefusesALibraryThatTheFolderDoesNotName) {
  EXPECT_THAT(smallTable().violations({.path = "hal/camera.h", .lines = {"#include <arv.h>"}}),
              ElementsAre(HasSubstr("hal may not use the library of <arv.h>")));
}

TEST(LayerTable, RefusesAFolderThatHasNoRow) {
  EXPECT_THAT(smallTable().violations({.path = "extra/x.cpp", .lines = {}}),
              ElementsAre(HasSubstr("no row")));
}

TEST(LayerTable, RefusesAnIncludeThatIsNotWrittenFromTheRoot) {
  EXPECT_THAT(smallTable().violations({.path = "rt/clock.cpp", .lines = {"#include \"clock.h\""}}),
              ElementsAre(HasSubstr("not written from the root")));
}

LayerTable tableOfThePage() {
  return LayerTable::fromPage(lint::read(lint::root(), "docs/architecture.md"));
}

TEST(Tree, KeepsToTheLayerTableOfTheArchitecturePage) {
  const auto table = tableOfThePage();
  ASSERT_GE(table.layers().size(), 8u) << "the layer table is missing from docs/architecture.md";
  const auto files = lint::cppFilesOf(lint::readTree(lint::root()));
  ASSERT_GE(files.size(), 20u) << "no sources under " << lint::root();
  for (const auto& file : files) {
    for (const auto& violation : table.violations(file)) ADD_FAILURE() << violation;
  }
}

TEST(Tree, HasEveryFolderOfTheLayerTable) {
  const auto table = tableOfThePage();
  for (const auto& layer : table.layers()) {
    const std::string folder = layer.folder.ends_with("/*")
                                   ? layer.folder.substr(0, layer.folder.size() - 2)
                                   : layer.folder;
    EXPECT_TRUE(std::filesystem::exists(lint::root() / folder)) << layer.folder;
  }
}

/// The folder of a header of a part that has no row of its own; empty: it is none.
std::string partOf(const LayerTable& table, const std::string& header) {
  const bool has_row = std::ranges::any_of(table.layers(), [&](const auto& layer) {
    return !layer.folder.ends_with("/*") && header.starts_with(layer.folder) &&
           layer.folder.starts_with("appliance/");
  });
  if (has_row || !header.starts_with("appliance/")) return {};
  return header.substr(0, header.rfind('/'));
}

// The bound of HACKING.md, "Adding a part": code outside a part's folder names it in two files.
TEST(Tree, NamesAPartInTheTableOfPartsAndInTheConfigurationOnly) {
  const auto table = tableOfThePage();
  std::set<std::string> parts;
  for (const auto& file : lint::cppFilesOf(lint::readTree(lint::root()))) {
    if (!file.path.starts_with("appliance/") || file.path.starts_with("appliance/tools/")) continue;
    for (const auto& line : file.lines) {
      static const std::regex kInclude(R"re(^#include "(appliance/[^"]+)")re");
      std::smatch match;
      if (!std::regex_search(line, match, kInclude)) continue;
      const std::string part = partOf(table, match[1]);
      if (part.empty()) continue;
      parts.insert(part);
      const bool own = file.path.starts_with(part + "/");
      EXPECT_TRUE(own || file.path == "appliance/box/parts.cpp" ||
                  file.path == "appliance/config/config.h")
          << file.path << " names " << match[1];
    }
  }
  EXPECT_THAT(parts, testing::IsSupersetOf({"appliance/depth", "appliance/panel"}));
}

}  // namespace
