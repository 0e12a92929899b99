// Messages over real sockets of this machine, on ports that the system picks.
#include <gtest/gtest.h>

#include <thread>

#include "drivers/openigtlink/content.h"
#include "drivers/openigtlink/openigtlink_decoder.h"
#include "drivers/transport/tcp_server.h"
#include "drivers/transport/tcp_source.h"
#include "drivers/vrpn/vrpn_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

constexpr Duration patience = std::chrono::minutes(5);  // of a test that would otherwise hang

std::unique_ptr<TcpServer> server(TcpServer::Options options = {}) {
  auto opened = TcpServer::open(std::move(options));
  EXPECT_TRUE(opened) << opened.error().message;
  return std::move(*opened);
}

std::unique_ptr<TcpSource> client(const TcpServer& server,
                                  std::function<FrameFit(Bytes)> fit = openigtlink::fit_message) {
  auto opened = TcpSource::open({.port = server.port(), .fit = std::move(fit)});
  EXPECT_TRUE(opened) << opened.error().message;
  return std::move(*opened);
}

Transfer next(TcpSource& source) {
  const auto read = source.read(monotonic_now() + patience);
  EXPECT_TRUE(read && *read);
  return read && *read ? **read : Transfer{};
}

openigtlink::ToolPose pose(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0, 0)}; }

TEST(Tcp, PosesReachEveryClient) {
  auto host = server();
  auto one = client(*host);
  auto two = client(*host);
  while (host->clients() < 2) host->attend();
  for (int i = 0; i < 100; ++i) host->send(openigtlink::write_transform("Brush", 1, pose(i * 0.001)));
  for (TcpSource* source : {one.get(), two.get()}) {
    OpenIgtLinkDecoder decoder;
    for (int i = 0; i < 100; ++i) {
      const auto out = decoded(decoder, next(*source));
      ASSERT_EQ(out.samples.size(), 1u);
      EXPECT_NEAR(std::get<PoseSample>(out.samples[0]).tracker_from_tool.translation.x(), i * 0.001, 1e-6);
    }
  }
}

TEST(Tcp, AVrpnServersWelcomeIsItsCookieAndItsNames) {
  TcpServer::Options options;
  append(options.welcome, vrpn::write_cookie());
  append(options.welcome, vrpn::write_description(vrpn::sender_description, 0, "Brush"));
  append(options.welcome, vrpn::write_description(vrpn::type_description, 0, vrpn::pose_type));
  auto host = server(std::move(options));
  auto source = client(*host, vrpn::fit_message);
  VrpnDecoder decoder;
  for (const Transfer& greeting : decoder.greeting()) EXPECT_TRUE(source->write(greeting));
  while (host->clients() < 1) host->attend();
  host->send(vrpn::write_message({.time_us = 5, .sender = 0, .type = 0, .body = vrpn::write_pose({})}));
  Decoded out;
  while (out.samples.empty()) decoder.decode(next(*source), out);
  EXPECT_EQ(std::get<PoseSample>(out.samples[0]).tool, "Brush");
}

TEST(Tcp, ACloseIsOneUnpluggedAndThenTheEnd) {
  auto host = server();
  auto source = client(*host);
  while (host->clients() < 1) host->attend();
  host->send(openigtlink::write_transform("Brush", 1, pose(0)));
  host.reset();
  EXPECT_EQ(next(*source).kind, TransferKind::message);
  EXPECT_EQ(next(*source).kind, TransferKind::unplugged);
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(source->read(std::nullopt).error().fault, Fault::device_gone);
}

TEST(Tcp, NobodyThereIsSaid) {
  std::uint16_t port = 0;
  { port = server()->port(); }
  const auto opened = TcpSource::open({.port = port, .fit = openigtlink::fit_message});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().fault, Fault::device_gone);
  EXPECT_NE(opened.error().message.find("is the server running?"), std::string::npos);
}

TEST(Tcp, APortThatIsTakenAndAnAddressThatIsNone) {
  auto host = server();
  EXPECT_EQ(TcpServer::open({.port = host->port()}).error().fault, Fault::busy);
  EXPECT_EQ(TcpServer::open({.address = "the moon"}).error().fault, Fault::usage);
}

TEST(Tcp, APeerThatHangsCostsNothingButItsDeadlineAndWakeEndsTheWait) {
  auto host = server();
  auto source = client(*host);
  const auto nothing = source->read(monotonic_now() + std::chrono::milliseconds(1));
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(*nothing);
  std::thread reader([&] {
    const auto woken = source->read(std::nullopt);
    EXPECT_TRUE(woken && !*woken);
  });
  source->wake();
  reader.join();
}

TEST(Tcp, APeerThatNeverReadsIsDroppedAndTheOthersGoOn) {
  auto host = server({.most_waiting_bytes = 100'000});
  auto slow = client(*host);
  while (host->clients() < 1) host->attend();
  const auto message = openigtlink::write_message("IMAGE", "x", 1, std::vector<std::byte>(50'000));
  for (int i = 0; i < 10'000 && host->clients() > 0; ++i) host->send(message);
  EXPECT_EQ(host->counts().slow, 1u);
  auto other = client(*host);
  while (host->clients() < 1) host->attend();
  host->send(openigtlink::write_transform("Brush", 1, pose(0)));
  EXPECT_EQ(next(*other).kind, TransferKind::message);
}

TEST(Tcp, DrainingWaitsForThoseWhoReadAndDropsThoseWhoDoNot) {
  auto host = server({.most_waiting_bytes = std::size_t{1} << 30});
  auto reads = client(*host);
  while (host->clients() < 1) host->attend();
  const auto message = openigtlink::write_transform("Brush", 1, pose(0));
  constexpr int sent = 200'000;  // far more than a socket holds
  for (int i = 0; i < sent; ++i) host->send(message);
  EXPECT_GT(host->waiting_bytes(), 0u);
  std::thread reader([&] {
    for (int i = 0; i < sent; ++i) ASSERT_EQ(next(*reads).payload, message);
  });
  host->drain(monotonic_now() + patience);
  EXPECT_EQ(host->waiting_bytes(), 0u);
  EXPECT_EQ(host->clients(), 1u);
  reader.join();
  for (int i = 0; i < sent; ++i) host->send(message);
  host->drain(monotonic_now());
  EXPECT_EQ(host->clients(), 0u);
  EXPECT_EQ(host->counts().slow, 1u);
}

TEST(Tcp, WhoeverLeavesIsNotedAndTooManyAreRefused) {
  auto host = server({.most_clients = 1});
  auto first = client(*host);
  while (host->clients() < 1) host->attend();
  auto second = client(*host);
  while (host->counts().refused < 1) host->attend();
  EXPECT_EQ(next(*second).kind, TransferKind::unplugged);
  first.reset();
  while (host->counts().left < 1) host->attend();
  EXPECT_EQ(host->clients(), 0u);
}

TEST(Tcp, AFloodOfNonsenseGivesNoMessagesAndTheNextGoodOneIsRead) {
  TcpServer::Options options;
  std::uint32_t state = 7;
  for (int i = 0; i < 300'000; ++i) {
    state = state * 1664525 + 1013904223;
    options.welcome.push_back(static_cast<std::byte>(state >> 24 & 3));  // many beginnings of headers
  }
  auto host = server(std::move(options));
  auto source = client(*host);
  while (host->clients() < 1) host->attend();
  const auto good = openigtlink::write_transform("Brush", 1, pose(0));
  std::thread sender([&] {
    for (int i = 0; i < 2000 && host->clients() > 0; ++i) host->send(good);
  });
  EXPECT_EQ(next(*source).payload, good);
  source.reset();
  sender.join();
}

}  // namespace
}  // namespace fude
