#include "hal/emulated/studio/noise.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/random.h"

namespace emulator::studio {

cv::Mat whiteNoise(cv::Size size, std::uint64_t seed) {
  cv::Mat noise(size, CV_32F);
  Random random(seed);
  for (int y = 0; y < size.height; ++y) {
    auto* row = noise.ptr<float>(y);
    for (int x = 0; x < size.width; ++x) row[x] = random.uniform(-1, 1);
  }
  return noise;
}

cv::Mat fractalNoise(cv::Size size, int coarse_px, int octaves, std::uint64_t seed) {
  cv::Mat sum(size, CV_32F, cv::Scalar(0.5));
  float strength = 0.35f;
  for (int octave = 0; octave < octaves; ++octave) {
    const int step = std::max(1, coarse_px >> octave);
    const cv::Size knots(std::max(2, size.width / step), std::max(2, size.height / step));
    cv::Mat grid = whiteNoise(knots, seed * 31 + static_cast<std::uint64_t>(octave));
    // Two knots of border from the other side make it tile.
    cv::copyMakeBorder(grid, grid, 2, 2, 2, 2, cv::BORDER_WRAP);
    const double fx = static_cast<double>(size.width) / knots.width;
    const double fy = static_cast<double>(size.height) / knots.height;
    cv::Mat fine;
    // OpenCV's centres: out + 0.5 = (in + 0.5) * f; shifted by the border.
    const cv::Matx23d map(fx, 0, (0.5 - 2) * fx - 0.5, 0, fy, (0.5 - 2) * fy - 0.5);
    cv::warpAffine(grid, fine, map, size, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    cv::scaleAdd(fine, strength, sum, sum);
    strength *= 0.5f;
  }
  cv::min(sum, 1.0, sum);
  cv::max(sum, 0.0, sum);
  return sum;
}

}  // namespace emulator::studio
