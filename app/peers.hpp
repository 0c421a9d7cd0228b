// The processes that share a batch, on one machine or on many.
#pragma once

#include <cstddef>
#include <string>

namespace shapeid::app {

/// Every one was given the same command and sees the same files. Number 0 prints.
class Peers {
 public:
  Peers() = default;
  Peers(const Peers&) = delete;
  Peers& operator=(const Peers&) = delete;
  virtual ~Peers() = default;

  [[nodiscard]] virtual std::size_t rank() const = 0;
  [[nodiscard]] virtual std::size_t count() const = 0;
  /// Messages from one process to another arrive in the order in which they were sent.
  virtual void send(const std::string& bytes, std::size_t to) = 0;
  /// Waits for the next message.
  [[nodiscard]] virtual std::string receive(std::size_t from) = 0;
};

/// One process, which has nobody to talk to.
class Alone final : public Peers {
 public:
  [[nodiscard]] std::size_t rank() const override { return 0; }
  [[nodiscard]] std::size_t count() const override { return 1; }
  void send(const std::string& bytes, std::size_t to) override;
  [[nodiscard]] std::string receive(std::size_t from) override;
};

}  // namespace shapeid::app
