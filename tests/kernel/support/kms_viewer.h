#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hal/display.h"
#include "tests/kernel/support/scanout_reader.h"
#include "ui-kms/kms_display.h"

namespace test {

/// A screen, pictures for it that differ from one another, and patience: what the tests of scanout
/// share.
class KmsViewer {
 public:
  /// Small and quick, on @p card.
  [[nodiscard]] static ui::KmsConfig quick(const std::string& card);

  /// Fails the test and leaves nothing where the display does not open.
  explicit KmsViewer(const ui::KmsConfig& config);

  [[nodiscard]] ui::KmsDisplay& display() { return *display_; }
  [[nodiscard]] explicit operator bool() const { return display_ != nullptr; }

  /// Draws and commits a picture like no other before, as often as it takes; its flip. None where
  /// no picture comes on screen within @p patience.
  [[nodiscard]] std::optional<hal::PageFlip> show(
      rt::Nanoseconds patience = std::chrono::seconds(20));
  /// Calls the display as a render loop does that has nothing to show, until it says @p state.
  [[nodiscard]] bool waitFor(hal::ScreenState state,
                             rt::Nanoseconds patience = std::chrono::seconds(20));

  /// What the display says it drew last.
  [[nodiscard]] ScannedOut drawn();
  /// Pixels that differ between that and what the card scans out.
  [[nodiscard]] std::size_t differs(ScanoutReader& reader);

 private:
  [[nodiscard]] rt::Result<rt::Timestamp> tryShow();

  std::unique_ptr<ui::KmsDisplay> display_;
  std::vector<std::byte> pixels_;
  std::uint64_t pictures_ = 0;
};

}  // namespace test
