// Ranks: the processes of one MPI program, and how they fail together.
//
// Every meeting of the ranks (each collective member below) begins with one small reduction that asks whether anybody
// has failed. So a rank that fails, wherever that is, goes to the next meeting and says so: all ranks then leave it
// with the same exception, Failure, and nobody waits for somebody who is not coming. What the ranks do between meetings
// they do alone; whoever fails there sends word to the others, which look_out() finds, so that they do not work on for
// nothing.
//
// Rules for callers: all ranks come to the same meetings in the same order; memory for what a meeting brings is taken
// by the meeting itself, between its reduction and its data, after a second reduction.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace blackleaf::mpi {

/// How the run has ended for all ranks.
class Failure : public std::exception {
 public:
  Failure(int code, std::string message) : code_(code), message_(std::move(message)) {}
  const char* what() const noexcept override { return message_.c_str(); }
  int code() const { return code_; }

 private:
  int code_;
  std::string message_;
};

class Ranks {
 public:
  /// Starts MPI; from here to the destructor, which ends it. Once in a process.
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool first() const { return rank_ == 0; }

  /// Waits for all ranks. Throws Failure on all if one of them has failed.
  void meet();
  /// For a rank that cannot go on: sends word to the others and meets them, and returns how all end: with the message
  /// of the lowest rank that has one. `code` is the exit status. A rank that only stops because another has sent word
  /// has no message.
  Failure fail(int code, const std::string& message) noexcept;
  /// Throws Stopped when another rank has sent word. From any thread, cheap.
  void look_out();
  /// What look_out() throws: to be answered with fail(0, "").
  class Stopped : public std::exception {
   public:
    const char* what() const noexcept override { return "another rank has failed"; }
  };

  // Meetings.

  /// The bytes of the first rank, for all.
  void broadcast(std::vector<std::uint8_t>& bytes);
  /// Every place becomes the sum over all ranks.
  void sum(std::span<std::uint64_t> numbers);
  /// The largest over all ranks.
  std::uint64_t largest(std::uint64_t number);
  /// One number from each rank, in order of rank.
  std::vector<std::uint64_t> gather(std::uint64_t number);

  /// Words from each rank, in order of rank, for all.
  std::vector<std::vector<std::uint64_t>> gather(const std::vector<std::uint64_t>& words);

  /// Words for another rank, and what other ranks have for this one. All ranks call it; `to` < 0: nothing to send.
  /// The ranks in `from` send to this one; returns what they sent, in that order.
  std::vector<std::vector<std::uint64_t>> exchange(int to, const std::vector<std::uint64_t>& words,
                                                   const std::vector<int>& from);

  /// To be held during MPI calls that are no meetings: one thread at a time.
  std::mutex& turn() { return turn_; }

 private:
  enum class State { well, stopped, failed };
  // The reduction. Returns without an exception only if all are well.
  void agree(State state, int code, const std::string& message);

  int rank_ = 0, size_ = 1;
  bool over_ = false;  // all have heard of a failure: no more meetings
  std::mutex turn_;
  std::chrono::steady_clock::time_point next_look_{};  // under turn_
};

/// The text of an MPI error.
std::string error_text(int error);

}  // namespace blackleaf::mpi
