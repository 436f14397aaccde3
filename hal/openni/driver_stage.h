#pragma once

#include <expected>
#include <filesystem>
#include <string>

namespace hal::openni {

/// A folder from which OpenNI2 loads the drivers of our choice.
///
/// OpenNI2 searches for drivers only in the folder of its own library, and only for names that end
/// in ".so.0". So its library is copied into a folder of its own, with links to the driver of
/// recordings and to everything in the configured folder. The process that uses it starts with
/// this folder first in LD_LIBRARY_PATH. One that was killed leaves its folder behind; the next
/// make() removes it.
///
/// Threads  One caller.
/// Errors   One line for a person: no such folder, no driver in it, no OpenNI2 here.
class DriverStage {
 public:
  /// @p drivers: a folder with one or more lib*.so, and what else they need.
  [[nodiscard]] static std::expected<DriverStage, std::string> make(
      const std::filesystem::path& drivers);

  /// One that make() made, in this process or in the one that became this one. A folder that does
  /// not bear such a name is left alone: it comes from the environment.
  explicit DriverStage(std::filesystem::path folder);

  DriverStage(DriverStage&& other) noexcept : folder_(std::move(other.folder_)) {
    other.folder_.clear();
  }
  DriverStage& operator=(DriverStage&&) = delete;
  ~DriverStage() { remove(); }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Once the drivers are loaded it is not needed any more.
  void remove();

 private:
  std::filesystem::path folder_;
};

}  // namespace hal::openni
