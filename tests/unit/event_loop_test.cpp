#include "appliance/loop/event_loop.h"

#include <csignal>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "rt/event_bell.h"
#include "rt/periodic_loop.h"

namespace {

using appliance::EventLoop;
using std::chrono::milliseconds;
using testing::HasSubstr;

std::unique_ptr<EventLoop> makeLoop() {
  auto loop = EventLoop::create();
  EXPECT_TRUE(loop.has_value()) << loop.error();
  return std::move(*loop);
}

/// How a child ends that runs @p body: its exit status, or 128 and its signal.
int endOfChild(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(EventLoop, CallsATimerAgainAndAgain) {
  const auto loop = makeLoop();
  int calls = 0;
  ASSERT_TRUE(loop->every(milliseconds(1), [&] {
    if (++calls == 5) loop->requestStop();
  }));
  EXPECT_TRUE(loop->run().has_value());
  EXPECT_EQ(calls, 5);
}

TEST(EventLoop, DoesNotMakeUpForCallsThatCameLate) {
  const auto loop = makeLoop();
  int calls = 0;
  const rt::Timestamp begin = rt::now();
  ASSERT_TRUE(loop->every(milliseconds(10), [&] {
    if (++calls == 1) rt::sleepUntil(rt::now() + milliseconds(200));
    if (calls == 4) loop->requestStop();
  }));
  ASSERT_TRUE(loop->run().has_value());
  // The first at 10 ms, the second late after 200 ms, two more a period apart.
  EXPECT_GE(rt::now() - begin, milliseconds(225));
}

TEST(EventLoop, HearsABellThatARealTimeThreadRings) {
  const auto loop = makeLoop();
  const rt::EventBell bell;
  ASSERT_TRUE(bell.valid());
  bell.ring();
  bell.ring();
  int heard = 0;
  ASSERT_TRUE(loop->watch(bell.fd(), [&] {
    EXPECT_TRUE(bell.takeRings());
    EXPECT_FALSE(bell.takeRings());
    ++heard;
    loop->requestStop();
  }));
  EXPECT_TRUE(loop->run().has_value());
  EXPECT_EQ(heard, 1);
}

TEST(EventLoop, ATimerIsHeardBesideADescriptorThatIsAlwaysReadable) {
  const auto loop = makeLoop();
  const rt::EventBell bell;
  bell.ring();
  int timer_calls = 0;
  ASSERT_TRUE(loop->watch(bell.fd(), [] {}));
  ASSERT_TRUE(loop->every(milliseconds(1), [&] {
    if (++timer_calls == 3) loop->requestStop();
  }));
  EXPECT_TRUE(loop->run().has_value());
  EXPECT_EQ(timer_calls, 3);
}

TEST(EventLoop, AnExceptionOfAHandlerEndsItWithALine) {
  const auto loop = makeLoop();
  ASSERT_TRUE(loop->every(milliseconds(1), [] { throw std::runtime_error("no memory"); }));
  const auto ended = loop->run();
  ASSERT_FALSE(ended.has_value());
  EXPECT_THAT(ended.error(), HasSubstr("no memory"));
}

TEST(EventLoop, RefusesADescriptorThatIsNotOne) {
  EXPECT_FALSE(makeLoop()->watch(-1, [] {}).has_value());
}

TEST(EventLoop, EveryStopSignalEndsIt) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(endOfChild([signal] {
                const auto loop = makeLoop();
                (void)loop->stopOnSignals();
                raise(signal);
                return loop->run() ? 7 : 1;
              }),
              7)
        << signal;
  }
}

TEST(EventLoop, ASecondStopSignalEndsTheProcessImmediately) {
  EXPECT_EQ(endOfChild([] {
              const auto loop = makeLoop();
              (void)loop->stopOnSignals();
              raise(SIGTERM);
              (void)loop->run();
              raise(SIGINT);
              return 7;
            }),
            128 + SIGINT);
}

TEST(EventLoop, AHangUpThatIsIgnoredStaysIgnored) {
  EXPECT_EQ(endOfChild([] {
              std::signal(SIGHUP, SIG_IGN);
              const auto loop = makeLoop();
              (void)loop->stopOnSignals();
              raise(SIGHUP);
              int ticks = 0;
              (void)loop->every(milliseconds(1), [&] {
                if (++ticks == 3) loop->requestStop();
              });
              (void)loop->run();
              return ticks;
            }),
            3);
}

}  // namespace
