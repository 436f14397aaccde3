#include <algorithm>
#include <array>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/gvcp.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)
using testing::ElementsAre;

std::vector<std::uint8_t> command(std::uint8_t flags, std::uint16_t code, std::uint16_t id,
                                  const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> bytes(8 + payload.size());
  bytes[0] = 0x42;
  bytes[1] = flags;
  storeBe16(&bytes[2], code);
  storeBe16(&bytes[4], static_cast<std::uint16_t>(payload.size()));
  storeBe16(&bytes[6], id);
  std::ranges::copy(payload, bytes.begin() + 8);
  return bytes;
}

TEST(GvcpParse, UnderstandsARegisterWrite) {
  const auto bytes = command(1, 0x0082, 0x1234, {0, 0, 0x0a, 0, 0, 0, 0, 2});
  const auto parsed = gvcp::parse(bytes);
  ASSERT_TRUE(parsed);
  EXPECT_TRUE(parsed->wants_answer);
  EXPECT_EQ(parsed->request_id, 0x1234);
  const auto* write = std::get_if<gvcp::WriteRegister>(&parsed->body);
  ASSERT_NE(write, nullptr);
  EXPECT_EQ(loadBe32(&write->pairs[0]), 0x0a00u);
  EXPECT_EQ(loadBe32(&write->pairs[4]), 2u);
}

TEST(GvcpParse, TakesTheRangeOfAResendWithoutItsFlagBits) {
  const auto bytes = command(0, 0x0040, 7, {0, 0, 0x01, 0x02, 0xff, 0, 0, 3, 0xff, 0, 0, 9});
  const auto parsed = gvcp::parse(bytes);
  ASSERT_TRUE(parsed);
  EXPECT_FALSE(parsed->wants_answer);
  const auto* resend = std::get_if<gvcp::PacketResend>(&parsed->body);
  ASSERT_NE(resend, nullptr);
  EXPECT_EQ(resend->block_id, 0x0102);
  EXPECT_EQ(resend->first_packet, 3u);
  EXPECT_EQ(resend->last_packet, 9u);
}

TEST(GvcpParse, NamesAWellFormedStrangerUnknown) {
  const auto parsed = gvcp::parse(command(1, 0x7770, 1, {}));
  ASSERT_TRUE(parsed);
  EXPECT_TRUE(std::holds_alternative<gvcp::Unknown>(parsed->body));
}

TEST(GvcpParse, IgnoresWhatIsNoCommand) {
  EXPECT_FALSE(gvcp::parse({}));
  EXPECT_FALSE(gvcp::parse(std::array<std::uint8_t, 3>{0x42, 1, 0}));
  auto other_protocol = command(1, 0x0080, 1, {0, 0, 0, 0});
  other_protocol[0] = 0x43;
  EXPECT_FALSE(gvcp::parse(other_protocol));
}

TEST(GvcpParse, IgnoresLengthsThatDoNotFit) {
  auto longer_than_sent = command(1, 0x0080, 1, {0, 0, 0, 0});
  storeBe16(&longer_than_sent[4], 8);
  EXPECT_FALSE(gvcp::parse(longer_than_sent));
  EXPECT_FALSE(gvcp::parse(command(1, 0x0080, 1, {0, 0, 0})));           // no whole address
  EXPECT_FALSE(gvcp::parse(command(1, 0x0082, 1, {0, 0, 0, 0})));        // no value
  EXPECT_FALSE(gvcp::parse(command(1, 0x0084, 1, {0, 0, 0, 0})));        // no count
  EXPECT_FALSE(gvcp::parse(command(0, 0x0040, 1, {0, 0, 0, 0, 0, 0})));  // no range
  EXPECT_FALSE(gvcp::parse(command(1, 0x0080, 1, std::vector<std::uint8_t>(600))));
}

TEST(GvcpAnswer, EchoesTheRequestAndCarriesStatusAndPayload) {
  const auto parsed = gvcp::parse(command(1, 0x0080, 0xbeef, {0, 0, 0x0a, 0}));
  ASSERT_TRUE(parsed);
  gvcp::Answer answer(*parsed);
  answer.append32(0x01020304);
  EXPECT_THAT(answer.finish(gvcp::Status::kSuccess),
              ElementsAre(0, 0, 0x00, 0x81, 0, 4, 0xbe, 0xef, 1, 2, 3, 4));
}

TEST(GvcpAnswer, RefusesWithoutPayload) {
  const auto parsed = gvcp::parse(command(1, 0x0084, 1, {0, 0, 0, 0, 0, 0, 0, 4}));
  ASSERT_TRUE(parsed);
  gvcp::Answer answer(*parsed);
  answer.append32(5);
  answer.dropPayload();
  EXPECT_THAT(answer.finish(gvcp::Status::kAccessDenied),
              ElementsAre(0x80, 0x06, 0x00, 0x85, 0, 0, 0, 1));
}

}  // namespace
