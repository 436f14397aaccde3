#include "tests/kernel/support/vkms.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/kernel/support/files.h"

namespace test {
namespace {

const std::string kCards = "/sys/kernel/config/vkms";

constexpr const char* kConnected = "1";  // as DRM numbers them
constexpr const char* kDisconnected = "2";
constexpr const char* kPrimaryPlane = "1";

constexpr std::array<const char*, 4> kParts = {"connectors/screen", "encoders/encoder",
                                               "planes/primary", "crtcs/crtc"};
/// What may be wired to what: the folder of the wires, and their other end.
constexpr std::array<std::pair<const char*, const char*>, 3> kWires = {
    {{"planes/primary/possible_crtcs", "crtcs/crtc"},
     {"encoders/encoder/possible_crtcs", "crtcs/crtc"},
     {"connectors/screen/possible_encoders", "encoders/encoder"}}};

std::string wirePath(const std::string& config, const std::pair<const char*, const char*>& wire) {
  return config + "/" + wire.first + "/" + std::filesystem::path(wire.second).filename().string();
}

std::string findCard(const std::string& name) {
  for (const auto& entry :
       std::filesystem::directory_iterator("/sys/devices/faux/" + name + "/drm")) {
    const std::string card = entry.path().filename();
    if (card.starts_with("card")) return "/dev/dri/" + card;
  }
  throw std::runtime_error("the kernel made no card for " + name);
}

}  // namespace

bool Vkms::available() {
  return std::filesystem::exists(kCards);
}

Vkms::Vkms(std::string name, bool connected)
    : name_(std::move(name)), config_(kCards + "/" + name_) {
  std::filesystem::create_directory(config_);
  for (const char* part : kParts) std::filesystem::create_directory(config_ + "/" + part);
  for (const auto& wire : kWires) {
    std::filesystem::create_directory_symlink(config_ + "/" + wire.second, wirePath(config_, wire));
  }
  writeAttribute(config_ + "/planes/primary/type", kPrimaryPlane);
  writeAttribute(config_ + "/crtcs/crtc/writeback", "1");
  setConnected(connected);
  writeAttribute(config_ + "/enabled", "1");
  card_ = findCard(name_);
}

Vkms::~Vkms() {
  try {
    writeAttribute(config_ + "/enabled", "0");
  } catch (const std::runtime_error&) {  // NOLINT(bugprone-empty-catch): the bed ends with the test
  }
  for (const auto& wire : kWires) ::unlink(wirePath(config_, wire).c_str());
  for (const char* part : kParts) ::rmdir((config_ + "/" + part).c_str());
  ::rmdir(config_.c_str());
}

void Vkms::setConnected(bool connected) {
  writeAttribute(config_ + "/connectors/screen/status", connected ? kConnected : kDisconnected);
}

}  // namespace test
