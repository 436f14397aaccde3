#include "tests/kernel/support/gpio_sim.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/kernel/support/files.h"

namespace test {
namespace {

void makeFolder(const std::string& path) {
  if (::mkdir(path.c_str(), 0755) != 0) {
    throw std::runtime_error("cannot make " + path + ": " + std::strerror(errno));
  }
}

}  // namespace

GpioSim::GpioSim(std::string label, std::vector<std::string> lines)
    : label_(std::move(label)),
      lines_(std::move(lines)),
      config_("/sys/kernel/config/gpio-sim/" + label_) {
  const std::string bank = config_ + "/bank0";
  makeFolder(config_);
  makeFolder(bank);
  writeAttribute(bank + "/num_lines", std::to_string(lines_.size()));
  writeAttribute(bank + "/label", label_);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].empty()) continue;
    const std::string folder = bank + "/line" + std::to_string(i);
    makeFolder(folder);
    writeAttribute(folder + "/name", lines_[i]);
  }
  writeAttribute(config_ + "/live", "1");
  live_ = true;
  const std::string chip = readAttribute(bank + "/chip_name");
  path_ = "/dev/" + chip;
  devices_ = "/sys/devices/platform/" + readAttribute(config_ + "/dev_name") + "/" + chip;
}

GpioSim::~GpioSim() {
  try {
    remove();
  } catch (const std::runtime_error&) {  // NOLINT(bugprone-empty-catch): the bed ends with the test
  }
  // configfs wants its folders removed from the innermost; its attributes vanish with them.
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!lines_[i].empty()) ::rmdir((config_ + "/bank0/line" + std::to_string(i)).c_str());
  }
  ::rmdir((config_ + "/bank0").c_str());
  ::rmdir(config_.c_str());
}

void GpioSim::pull(const std::string& line, bool up) {
  writeAttribute(lineFolder(line) + "/pull", up ? "pull-up" : "pull-down");
}

bool GpioSim::level(const std::string& line) const {
  return readAttribute(lineFolder(line) + "/value") == "1";
}

std::string GpioSim::lineFolder(const std::string& line) const {
  const auto found = std::ranges::find(lines_, line);
  if (line.empty() || found == lines_.end()) {
    throw std::runtime_error("chip " + label_ + " has no line '" + line + "'");
  }
  return devices_ + "/sim_gpio" + std::to_string(found - lines_.begin());
}

void GpioSim::remove() {
  if (!live_) return;
  live_ = false;
  writeAttribute(config_ + "/live", "0");
}

}  // namespace test
