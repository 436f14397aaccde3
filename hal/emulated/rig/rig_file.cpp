#include "hal/emulated/rig/rig_file.h"

#include <fstream>
#include <iterator>
#include <sstream>

#include <toml++/toml.h>

#include "rt/printable.h"

namespace emulator {
namespace {

constexpr std::int64_t kFormat = 1;  // of what is written: it needs no key of a newer one
constexpr std::int64_t kLargestSidePx = 16'384;

/// What toml++ writes it can read again, at full precision: 1e11 as well as 0.1.
template <std::size_t N>
toml::array list(const std::array<double, N>& values) {
  toml::array list;
  for (const double value : values) list.push_back(value);
  return list;
}

std::string place(const std::filesystem::path& path, const toml::node& node) {
  return path.string() + ":" + std::to_string(node.source().begin.line) + ": ";
}

std::expected<CameraModel, std::string> readCamera(const std::filesystem::path& path,
                                                   const toml::table& table) {
  CameraModel camera;
  camera.name = table["name"].value_or(std::string());
  if (camera.name.empty()) {
    return std::unexpected(place(path, table) + "a [[camera]] needs name = \"...\"");
  }
  const auto* size = table["image_size_px"].as_array();
  const bool two = size != nullptr && size->size() == 2;
  // Exact: what converts a fraction to a whole number has no answer for 1e70.
  const std::int64_t width = two ? (*size)[0].value_exact<std::int64_t>().value_or(0) : 0;
  const std::int64_t height = two ? (*size)[1].value_exact<std::int64_t>().value_or(0) : 0;
  if (width <= 0 || height <= 0 || width > kLargestSidePx || height > kLargestSidePx) {
    return std::unexpected(place(path, table) + "camera \"" + rt::printable(camera.name) +
                           "\" needs image_size_px = [width, height], whole numbers");
  }
  camera.image_size = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  return camera;
}

}  // namespace

std::string toToml(const RigModel& rig) {
  std::ostringstream text;
  text << "format = " << kFormat << "\nname = \"" << rig.name << "\"\n"
       << "target_m = " << list(rig.target_m) << "\n";
  for (const CameraModel& c : rig.cameras) {
    text << "\n[[camera]]\nname = \"" << c.name << "\"\n"
         << "image_size_px = [" << c.image_size.width << ", " << c.image_size.height << "]\n"
         << "focal_px = " << list(c.focal_px) << "\n"
         << "centre_px = " << list(c.centre_px) << "\n"
         << "distortion = " << list(c.distortion) << "\n"
         << "T_cam_rig = [";
    for (std::size_t row = 0; row < 3; ++row) {
      const auto& r = c.rotation[row];
      text << (row == 0 ? "" : ",\n             ")
           << list(std::array{r[0], r[1], r[2], c.translation_m[row]});
    }
    text << "]\ngain_rgb = " << list(c.gain_rgb) << "\n";
  }
  return text.str();
}

std::expected<void, std::string> writeRigFile(const std::filesystem::path& path,
                                              const RigModel& rig) {
  std::ofstream file(path);
  file << toToml(rig);
  file.flush();
  if (!file) return std::unexpected("cannot write " + path.string());
  return {};
}

std::expected<RigModel, std::string> readRigFile(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) {
    return std::unexpected("there is no " + path.string() + ": the folder is no scene");
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return parseRigFile(text, path);
}

std::expected<RigModel, std::string> parseRigFile(std::string_view text,
                                                  const std::filesystem::path& name) {
  toml::table root;
  try {
    root = toml::parse(text, name.string());
  } catch (const toml::parse_error& error) {
    return std::unexpected(name.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                           rt::printable(error.description()));
  }
  // Names and sizes mean the same in every format.
  if (root["format"].value_exact<std::int64_t>().value_or(0) < kFormat) {
    return std::unexpected(name.string() + ": there is no format = 1 or newer: not a rig file");
  }
  RigModel rig;
  rig.name = root["name"].value_or(std::string());
  const auto* cameras = root["camera"].as_array();
  if (cameras == nullptr || cameras->empty()) {
    return std::unexpected(name.string() + ": there is no [[camera]]");
  }
  for (const toml::node& node : *cameras) {
    const auto* table = node.as_table();
    if (table == nullptr) {
      return std::unexpected(place(name, node) + "camera must be a list of tables, [[camera]]");
    }
    auto camera = readCamera(name, *table);
    if (!camera) return std::unexpected(camera.error());
    rig.cameras.push_back(std::move(*camera));
  }
  return rig;
}

}  // namespace emulator
