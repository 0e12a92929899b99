#include "drivers/transport/tcp_source.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace fude {
namespace {

int milliseconds_left(Timestamp deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - monotonic_now());
  return static_cast<int>(std::clamp<std::chrono::milliseconds::rep>(left.count(), 0, 1'000'000));
}

// Waits until the socket can be written; false when the time is over.
bool writable(int socket, Timestamp deadline) {
  pollfd waiting{socket, POLLOUT, 0};
  for (;;) {
    const int ready = poll(&waiting, 1, milliseconds_left(deadline));
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

FileDescriptor connected(const addrinfo& address, Timestamp deadline) {
  FileDescriptor socket(
      ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol));
  if (socket.get() < 0) return {};
  if (connect(socket.get(), address.ai_addr, address.ai_addrlen) != 0) {
    if (errno != EINPROGRESS || !writable(socket.get(), deadline)) return {};
    int error = 0;
    socklen_t size = sizeof error;
    if (getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error != 0) return {};
  }
  const int on = 1;
  setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return socket;
}

std::string name_of(const TcpSource::Options& options) {
  return options.host + ":" + std::to_string(options.port);
}

}  // namespace

Result<std::unique_ptr<TcpSource>> TcpSource::open(Options options) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int status =
          getaddrinfo(options.host.c_str(), std::to_string(options.port).c_str(), &hints, &found);
      status != 0)
    return failure(Fault::not_found, "no host " + options.host + ": " + gai_strerror(status));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  const Timestamp deadline = monotonic_now() + options.connect_within;
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next)
    if (FileDescriptor socket = connected(*address, deadline); socket.get() >= 0)
      return std::unique_ptr<TcpSource>(new TcpSource(std::move(options), std::move(socket)));
  return failure(Fault::device_gone, "nobody answers at " + name_of(options) + "; is the server running?");
}

TcpSource::TcpSource(Options options, FileDescriptor socket)
    : options_(std::move(options)), socket_(std::move(socket)) {}

Error TcpSource::gone() const {
  return {Fault::device_gone, name_of(options_) + " has closed the connection; connect again"};
}

Result<std::optional<Transfer>> TcpSource::read(std::optional<Timestamp> deadline) {
  for (;;) {
    if (!ready_.empty()) {
      std::optional<Transfer> first(std::move(ready_.front()));
      ready_.pop_front();
      return first;
    }
    if (gone_) return tl::unexpected(gone());
    const Waker::Outcome outcome = waker_.wait(socket_.get(), deadline);
    if (outcome.ready || outcome.gone) take_bytes();
    if (!ready_.empty()) continue;
    if (outcome.woken || !(outcome.ready || outcome.gone)) return std::nullopt;
    if (deadline && monotonic_now() >= *deadline) return std::nullopt;
  }
}

void TcpSource::take_bytes() {
  std::array<std::byte, 16384> buffer;
  const ssize_t count = recv(socket_.get(), buffer.data(), buffer.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count <= 0) return closed();
  const Timestamp now = monotonic_now();
  const auto fed = stream_.feed(Bytes(buffer).first(static_cast<std::size_t>(count)),
                                options_.longest_message, options_.fit, [&](Bytes message) {
                                  ready_.push_back({now,
                                                    StampedBy::arrival,
                                                    Direction::from_device,
                                                    TransferKind::message,
                                                    {message.begin(), message.end()}});
                                });
  skipped_.damaged += fed.damaged;
  skipped_.foreign += fed.foreign;
}

void TcpSource::closed() {
  gone_ = true;
  ready_.push_back(
      {monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::unplugged, {}});
}

Result<void> TcpSource::write(const Transfer& transfer) {
  if (transfer.kind != TransferKind::message)
    return failure(Fault::unsupported, "a network peer takes messages alone");
  const Timestamp deadline = monotonic_now() + options_.write_within;
  Bytes left(transfer.payload);
  while (!left.empty()) {
    const ssize_t count = send(socket_.get(), left.data(), left.size(), MSG_NOSIGNAL);
    if (count >= 0) {
      left = left.subspan(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (writable(socket_.get(), deadline)) continue;
      shutdown(socket_.get(), SHUT_RDWR);
      return failure(Fault::device_gone, name_of(options_) + " takes no messages; the connection is closed");
    } else if (errno != EINTR) {
      return tl::unexpected(gone());
    }
  }
  return {};
}

}  // namespace fude
