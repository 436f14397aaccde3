#pragma once

#include <rapidcheck.h>

namespace property_test {

/// Any number of [lowest, end): the whole range from the first case on, where rapidcheck's own
/// inRange() begins with its lower end alone.
template <class Number>
Number anyIn(Number lowest, Number end) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(lowest, end));
}

/// Any value of an unsigned type, every bit pattern alike.
template <class Number>
Number anyBits() {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<Number>());
}

}  // namespace property_test
