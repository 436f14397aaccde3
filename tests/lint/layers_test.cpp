#include <filesystem>

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
    EXPECT_TRUE(std::filesystem::exists(lint::root() / layer.folder)) << layer.folder;
  }
}

}  // namespace
