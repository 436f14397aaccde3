#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

/// Where a row or column of a white picture passes half of white's code; from its middle outwards.
inline double edgeAlong(const std::vector<float>& codes, int direction) {
  constexpr float kHalf = 128;
  const int middle = static_cast<int>(codes.size()) / 2;
  for (int at = middle; at > 0 && at + 1 < static_cast<int>(codes.size()); at += direction) {
    const float here = codes[static_cast<std::size_t>(at)];
    const float next = codes[static_cast<std::size_t>(at + direction)];
    if (next < kHalf) return at + direction * double{(here - kHalf) / (here - next)};
  }
  return direction < 0 ? 0 : static_cast<double>(codes.size() - 1);
}

/// Left, right, upper and lower edge along a third, the middle and two thirds of the picture.
inline std::vector<double> edgesOf(const cv::Mat3f& picture) {
  std::vector<double> edges;
  for (const int part : {1, 2, 3}) {
    std::vector<float> row;
    std::vector<float> column;
    for (int x = 0; x < picture.cols; ++x) row.push_back(picture(picture.rows * part / 4, x)[1]);
    for (int y = 0; y < picture.rows; ++y) column.push_back(picture(y, picture.cols * part / 4)[1]);
    for (const int direction : {-1, 1}) {
      edges.push_back(edgeAlong(row, direction));
      edges.push_back(edgeAlong(column, direction));
    }
  }
  return edges;
}
