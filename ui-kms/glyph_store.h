#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rt/annotations.h"
#include "rt/spsc_ring.h"

namespace ui {

/// Pages of rasterised letters, one byte of coverage per pixel. They fill as letters are needed;
/// when all are full, the one that was not used for longest is emptied.
///
/// One thread puts letters in and makes overlays of them, numbered from 1; another uploads the
/// letters and draws. A page is emptied only after the drawing thread has gone on to an overlay
/// that came after the page's last use, and it never goes back.
///
/// Threads  put(), use(), begin(), and the letters() made so far: the thread that makes overlays.
///          tryPopUpload(), adopt(): the one that draws. pixels(): both, each for letters it knows.
/// Memory   A page is made when the first letter needs it; at most kMostPages.
/// Errors   put(): no room now; more when the drawing thread has gone on.
class GlyphStore {
 public:
  static constexpr std::uint32_t kPagePx = 1024;
  static constexpr std::uint32_t kMostPages = 8;

  /// A letter's rectangle in the store.
  struct Place {
    std::uint8_t page = 0;
    std::uint16_t u_px = 0, v_px = 0, width_px = 0, height_px = 0;
    std::uint64_t filling = 0;  ///< of the page: another number, and the letter is gone
  };

  /// Overlay @p generation is being made from here on.
  void begin(std::uint64_t generation) { generation_ = generation; }
  /// @p rows: of a letter's coverage, @p pitch bytes apart.
  [[nodiscard]] std::optional<Place> put(std::uint16_t width_px, std::uint16_t height_px,
                                         const std::uint8_t* rows, std::ptrdiff_t pitch);
  [[nodiscard]] bool holds(const Place& place) const {
    return pages_[place.page].filling == place.filling;
  }
  /// The letter is in the overlay that is being made. False: its page was emptied.
  [[nodiscard]] bool use(const Place& place);
  /// Put in so far.
  [[nodiscard]] std::uint64_t letters() const { return letters_; }

  /// The next letter to upload, each once, in order.
  [[nodiscard]] std::optional<Place> tryPopUpload() RT_SAFE { return uploads_.tryPop(); }
  /// Overlay @p generation is drawn from here on, or a later one.
  void adopt(std::uint64_t generation) RT_SAFE {
    adopted_.store(generation, std::memory_order_release);
  }

  /// A page's pixels, kPagePx in a row.
  [[nodiscard]] std::span<const std::uint8_t> pixels(std::uint8_t page) const {
    return pages_[page].pixels;
  }

 private:
  struct Page {
    std::vector<std::uint8_t> pixels;
    std::uint64_t last_use = 0;
    std::uint64_t filling = 1;
    // Letters stand in rows from left to right, the rows from top to bottom.
    std::uint32_t x_px = 0, y_px = 0, row_px = 0;
  };
  static constexpr std::uint32_t kMostUploads = 512;

  [[nodiscard]] static bool makeRoom(Page& page, std::uint32_t width_px, std::uint32_t height_px);
  [[nodiscard]] Page* pageFor(std::uint32_t width_px, std::uint32_t height_px);

  std::array<Page, kMostPages> pages_;
  std::uint32_t made_ = 0;  // of them
  std::uint64_t generation_ = 0;
  std::uint64_t letters_ = 0;
  std::atomic<std::uint64_t> adopted_{0};
  rt::SpscRing<Place, kMostUploads> uploads_;
};

}  // namespace ui
