// A server of messages to whoever connects: loopback alone unless told otherwise.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "drivers/byte_order.h"
#include "drivers/transport/file_descriptor.h"
#include "signal/result.h"
#include "signal/timestamp.h"

namespace fude {

// One thread calls it; nothing in it waits but drain(). What clients send is read and thrown away.
class TcpServer {
 public:
  struct Options {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;  // 0: the system picks a free one
    std::size_t most_clients = 16;
    std::size_t most_waiting_bytes = 1 << 20;  // of one client, beyond what the system holds for it
    std::vector<std::byte> welcome;            // the first bytes to each client
  };

  struct Counts {
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;  // there were `most_clients` already
    std::uint64_t slow = 0;     // dropped: it did not take what it was sent
    std::uint64_t left = 0;
  };

  // Errors: usage for an address that is none, busy for a port that is taken.
  static Result<std::unique_ptr<TcpServer>> open(Options options);

  std::uint16_t port() const { return port_; }
  std::size_t clients() const { return clients_.size(); }
  const Counts& counts() const { return counts_; }

  // Lets in who waits at the door, and hands on what did not fit before. Call it a few times a second.
  void attend();

  // To every client, after attend().
  void send(Bytes message);

  // To every client that is there, and to later ones after the welcome.
  void announce(Bytes message);

  // What the client that is farthest behind has not taken yet, beyond what the system holds for it.
  std::size_t waiting_bytes() const;

  // Waits until every client has taken what was sent, or the deadline on CLOCK_MONOTONIC has passed: who has
  // not by then is dropped as slow.
  void drain(Timestamp deadline);

 private:
  struct Client {
    FileDescriptor socket;
    std::vector<std::byte> waiting;
  };
  enum class Standing : std::uint8_t { fine, slow, gone };

  TcpServer(Options options, FileDescriptor listening, std::uint16_t port);
  void let_in();
  Standing deliver(Client& client, Bytes message);
  void drop(std::list<Client>::iterator& client, Standing standing);

  Options options_;
  FileDescriptor listening_;
  std::uint16_t port_;
  std::list<Client> clients_;
  Counts counts_;
};

}  // namespace fude
