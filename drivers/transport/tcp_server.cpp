#include "drivers/transport/tcp_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "drivers/transport/waker.h"

namespace fude {

Result<std::unique_ptr<TcpServer>> TcpServer::open(Options options) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(options.port);
  if (inet_pton(AF_INET, options.address.c_str(), &address.sin_addr) != 1)
    return failure(Fault::usage, options.address + " is no address to listen on; 127.0.0.1 is this machine");
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  socklen_t size = sizeof address;
  if (bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(socket.get(), 16) != 0 ||
      getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    return failure(Fault::busy, "cannot listen on " + options.address + ":" + std::to_string(options.port) +
                                    " (" + std::strerror(errno) + "); choose another address or port");
  const std::uint16_t port = ntohs(address.sin_port);
  return std::unique_ptr<TcpServer>(new TcpServer(std::move(options), std::move(socket), port));
}

TcpServer::TcpServer(Options options, FileDescriptor listening, std::uint16_t port)
    : options_(std::move(options)), listening_(std::move(listening)), port_(port) {}

void TcpServer::let_in() {
  for (;;) {
    FileDescriptor socket(accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (socket.get() < 0) return;
    if (clients_.size() >= options_.most_clients) {
      ++counts_.refused;
      continue;
    }
    const int on = 1;
    setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ++counts_.accepted;
    clients_.push_back({std::move(socket), {}});
    auto last = std::prev(clients_.end());
    drop(last, deliver(*last, options_.welcome));
  }
}

void TcpServer::attend() {
  let_in();
  for (auto client = clients_.begin(); client != clients_.end();) {
    std::array<std::byte, 4096> ignored;
    const ssize_t count = recv(client->socket.get(), ignored.data(), ignored.size(), 0);
    const bool gone = count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
    drop(client, gone ? Standing::gone : deliver(*client, {}));
  }
}

void TcpServer::send(Bytes message) {
  attend();
  for (auto client = clients_.begin(); client != clients_.end();) drop(client, deliver(*client, message));
}

void TcpServer::announce(Bytes message) {
  send(message);
  append(options_.welcome, message);
}

std::size_t TcpServer::waiting_bytes() const {
  std::size_t most = 0;
  for (const Client& client : clients_) most = std::max(most, client.waiting.size());
  return most;
}

void TcpServer::drain(Timestamp deadline) {
  for (attend(); waiting_bytes() > 0; attend()) {
    const Duration left = deadline - monotonic_now();
    if (left <= Duration(0)) break;
    std::vector<pollfd> behind;
    for (const Client& client : clients_)
      if (!client.waiting.empty()) behind.push_back({client.socket.get(), POLLOUT, 0});
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec time{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
    ppoll(behind.data(), behind.size(), &time, nullptr);
  }
  for (auto client = clients_.begin(); client != clients_.end();)
    drop(client, client->waiting.empty() ? Standing::fine : Standing::slow);
}

TcpServer::Standing TcpServer::deliver(Client& client, Bytes message) {
  append(client.waiting, message);
  std::size_t sent = 0;
  while (sent < client.waiting.size()) {
    const ssize_t count =
        ::send(client.socket.get(), client.waiting.data() + sent, client.waiting.size() - sent, MSG_NOSIGNAL);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {
      break;
    } else if (errno != EINTR) {
      return Standing::gone;
    }
  }
  client.waiting.erase(client.waiting.begin(), client.waiting.begin() + static_cast<std::ptrdiff_t>(sent));
  return client.waiting.size() > options_.most_waiting_bytes ? Standing::slow : Standing::fine;
}

// Steps to the next client.
void TcpServer::drop(std::list<Client>::iterator& client, Standing standing) {
  if (standing == Standing::fine) {
    ++client;
    return;
  }
  ++(standing == Standing::slow ? counts_.slow : counts_.left);
  client = clients_.erase(client);
}

}  // namespace fude
