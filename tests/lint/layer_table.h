#pragma once

#include <string>
#include <vector>

#include "tests/lint/source_tree.h"

namespace lint {

/// One row of the layer table of docs/architecture.md.
struct Layer {
  /// A folder, or one file that has rules of its own; "a/*" is every folder in `a` that has no row,
  /// each for itself.
  std::string folder;
  std::vector<std::string> may_include;  ///< folders of other rows; "*" is any
  std::vector<std::string> libraries;    ///< foreign headers or their first folder; "*" is any
};

/// Which folder may include which. A path belongs to the row with the longest folder that begins
/// it.
class LayerTable {
 public:
  explicit LayerTable(std::vector<Layer> layers) : layers_(std::move(layers)) {}

  /// From the page's table whose first heading is "Folder"; no rows when it has none.
  [[nodiscard]] static LayerTable fromPage(const SourceFile& page);

  [[nodiscard]] const std::vector<Layer>& layers() const { return layers_; }

  /// One line "file:line: what" for every include of @p file that the table forbids.
  [[nodiscard]] std::vector<std::string> violations(const SourceFile& file) const;

 private:
  /// Where the row of @p path begins: its folder, and for "a/*" the folder in `a`.
  [[nodiscard]] static std::string placeOf(const Layer& layer, const std::string& path);
  [[nodiscard]] const Layer* layerOf(const std::string& path) const;

  std::vector<Layer> layers_;
};

}  // namespace lint
