#pragma once

#include <expected>
#include <filesystem>
#include <span>
#include <string>

#include "hal/emulated/studio/studio_options.h"
#include "hal/emulated/studio/studio_scene.h"

namespace emulator::studio {

/// Writes what a tracker or a coach's tool should find, for tests and evaluation only:
///   truth.json     rig with everything that scatters, moments per second, throws with their
///   instants moments.jsonl  one line per moment: second, phase, ball, and the joints of everybody
///   (COCO order,
///                  metres, rig frame)
[[nodiscard]] std::expected<void, std::string> writeTruth(const std::filesystem::path& folder,
                                                          const StudioOptions& options);

/// rounds.csv: the trigger at which each round of the play began, and how many moments it then had.
[[nodiscard]] std::expected<void, std::string> writeRounds(
    const std::filesystem::path& folder, std::span<const StudioScene::Round> rounds);

}  // namespace emulator::studio
