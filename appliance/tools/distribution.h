#pragma once

#include <cstddef>
#include <vector>

namespace appliance {

/// What a report says of many values. Without any value all are zero, the count, too.
struct Distribution {
  std::size_t count = 0;
  double mean = 0;
  double sd = 0;   ///< of the sample: divided by count - 1; 0 for a single value
  double p50 = 0;  ///< percentiles by nearest rank: a value that really occurred
  double p99 = 0;
  double p999 = 0;
  double max = 0;
};

[[nodiscard]] Distribution distributionOf(std::vector<double> values);

}  // namespace appliance
