#include "appliance/network/uplink_text.h"

#include <gtest/gtest.h>

namespace {

using appliance::parseUplinks;
using appliance::Uplinks;

TEST(UplinkText, IsReadAsPeopleWriteIt) {
  EXPECT_EQ(parseUplinks("10G"), (Uplinks{1, 10}));
  EXPECT_EQ(parseUplinks("2x10G"), (Uplinks{2, 10}));
  EXPECT_EQ(parseUplinks("4x2.5G"), (Uplinks{4, 2.5}));
  EXPECT_EQ(parseUplinks("100M"), (Uplinks{1, 0.1}));
}

TEST(UplinkText, IsRefusedWhereItIsAnythingElse) {
  for (const char* text : {"", "G", "10", "x10G", "0x10G", "2x", "2x10", "-1x10G", "10GB", "nanG",
                           "infG", "0G", "1e9G", "2x10G ", "65x10G", "99999999999999999999x1G"}) {
    const auto parsed = parseUplinks(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().find(text), 0U);
  }
}

}  // namespace
