// Transfers put from several threads while another waits.
#include "drivers/transport/inbox.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/fakes/transfers.h"

namespace fude {
namespace {

TEST(Inbox, NothingIsLostAndEachPutterKeepsItsOrder) {
  constexpr int putters = 3;
  constexpr int each = 2000;
  Inbox inbox;
  std::vector<std::thread> threads;
  for (int who = 0; who < putters; ++who)
    threads.emplace_back([&inbox, who] {
      for (int i = 0; i < each; ++i) {
        Transfer transfer = from_device(TransferKind::usb_bulk, {}, i);
        transfer.endpoint = static_cast<std::uint8_t>(who);
        inbox.put(std::move(transfer));
      }
    });
  std::vector<int> next(putters);
  for (int got = 0; got < putters * each;) {
    while (const auto transfer = inbox.take()) {
      EXPECT_EQ(transfer->time, Timestamp(std::chrono::milliseconds(next[transfer->endpoint]++)));
      ++got;
    }
    if (got < putters * each) inbox.wait(-1, std::nullopt);
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_FALSE(inbox.take());
}

TEST(Inbox, AWaitEndsByBeingWokenOnce) {
  Inbox inbox;
  std::thread waker([&inbox] { inbox.wake(); });
  EXPECT_TRUE(inbox.wait(-1, std::nullopt).woken);
  waker.join();
  const Inbox::Outcome after = inbox.wait(-1, monotonic_now());
  EXPECT_FALSE(after.woken);
  EXPECT_TRUE(after.late);
}

}  // namespace
}  // namespace fude
