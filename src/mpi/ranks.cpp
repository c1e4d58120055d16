#include "ranks.h"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace blackleaf::mpi {
namespace {

constexpr int kWordOfFailure = 1, kWords = 2;        // tags
constexpr std::size_t kMost = std::size_t{1} << 28;  // elements of one message: MPI counts in int

void broadcast_bytes(void* data, std::size_t bytes, int root) {
  auto* at = static_cast<unsigned char*>(data);
  for (std::size_t done = 0; done < bytes; done += kMost)
    MPI_Bcast(at + done, static_cast<int>(std::min(kMost, bytes - done)), MPI_BYTE, root, MPI_COMM_WORLD);
}

}  // namespace

Ranks::Ranks(int& argc, char**& argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  // Words of failure that nobody waits for any more.
  for (int there = 1; there != 0;) {
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, kWordOfFailure, MPI_COMM_WORLD, &there, &status);
    if (there != 0)
      MPI_Recv(nullptr, 0, MPI_BYTE, status.MPI_SOURCE, kWordOfFailure, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  MPI_Finalize();
}

void Ranks::agree(State state, int code, const std::string& message) {
  // The lowest rank with something to say, else the lowest that has stopped.
  struct {
    int value, rank;
  } mine{state == State::failed ? 0 : state == State::stopped ? 1 : 2, rank_}, all{};
  MPI_Allreduce(&mine, &all, 1, MPI_2INT, MPI_MINLOC, MPI_COMM_WORLD);
  if (all.value == 2) return;
  over_ = true;
  std::array<std::uint64_t, 2> head = {static_cast<std::uint64_t>(code), message.size()};
  MPI_Bcast(head.data(), 2, MPI_UINT64_T, all.rank, MPI_COMM_WORLD);
  std::string text = rank_ == all.rank ? message : std::string(head[1], ' ');
  broadcast_bytes(text.data(), text.size(), all.rank);
  throw Failure(static_cast<int>(head[0]), text);
}

void Ranks::meet() {
  const std::lock_guard lock(turn_);
  agree(State::well, 0, {});
}

Failure Ranks::fail(int code, const std::string& message) noexcept {
  try {
    const std::lock_guard lock(turn_);
    if (code != 0)
      // Nobody waits for these: who does not hear of it learns it from agree().
      for (int other = 0; other < size_; ++other) {
        if (other == rank_) continue;
        MPI_Request request{};
        MPI_Isend(nullptr, 0, MPI_BYTE, other, kWordOfFailure, MPI_COMM_WORLD, &request);
        MPI_Request_free(&request);
      }
    agree(code != 0 ? State::failed : State::stopped, code, message);
  } catch (const Failure& failure) {
    return failure;
  } catch (...) {
    MPI_Abort(MPI_COMM_WORLD, 3);
  }
  std::abort();  // agree() throws when anybody has failed, and this rank has
}

void Ranks::look_out() {
  if (size_ == 1) return;
  const std::unique_lock lock(turn_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  // Looking gives the processor away where ranks share one: not every time.
  const auto now = std::chrono::steady_clock::now();
  if (now < next_look_) return;
  next_look_ = now + std::chrono::milliseconds(100);
  int there = 0;
  MPI_Iprobe(MPI_ANY_SOURCE, kWordOfFailure, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
  if (there != 0) throw Stopped();
}

void Ranks::broadcast(std::vector<std::uint8_t>& bytes) {
  std::uint64_t size = bytes.size();
  meet();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  bytes.resize(size);
  meet();
  broadcast_bytes(bytes.data(), size, 0);
}

void Ranks::sum(std::span<std::uint64_t> numbers) {
  meet();
  for (std::size_t done = 0; done < numbers.size(); done += kMost)
    MPI_Allreduce(MPI_IN_PLACE, numbers.data() + done, static_cast<int>(std::min(kMost, numbers.size() - done)),
                  MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
}

std::uint64_t Ranks::largest(std::uint64_t number) {
  meet();
  MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  return number;
}

std::vector<std::uint64_t> Ranks::gather(std::uint64_t number) {
  std::vector<std::uint64_t> all(static_cast<std::size_t>(size_));
  meet();
  MPI_Allgather(&number, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  return all;
}

std::vector<std::vector<std::uint64_t>> Ranks::gather(const std::vector<std::uint64_t>& words) {
  const std::vector<std::uint64_t> sizes = gather(words.size());
  std::vector<std::vector<std::uint64_t>> all(sizes.size());
  for (std::size_t rank = 0; rank < all.size(); ++rank) all[rank].resize(sizes[rank]);
  all[static_cast<std::size_t>(rank_)] = words;
  meet();
  // One after the other: most ranks have nothing, and those that have much use the whole network.
  for (std::size_t rank = 0; rank < all.size(); ++rank)
    broadcast_bytes(all[rank].data(), all[rank].size() * sizeof(std::uint64_t), static_cast<int>(rank));
  return all;
}

std::vector<std::vector<std::uint64_t>> Ranks::exchange(int to, const std::vector<std::uint64_t>& words,
                                                        const std::vector<int>& from) {
  meet();
  std::uint64_t size = words.size();
  MPI_Request request = MPI_REQUEST_NULL;
  if (to >= 0) MPI_Isend(&size, 1, MPI_UINT64_T, to, kWords, MPI_COMM_WORLD, &request);
  std::vector<std::vector<std::uint64_t>> all(from.size());
  std::vector<std::uint64_t> sizes(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    MPI_Recv(&sizes[i], 1, MPI_UINT64_T, from[i], kWords, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  for (std::size_t i = 0; i < from.size(); ++i) all[i].resize(sizes[i]);
  meet();
  std::vector<MPI_Request> requests;
  for (std::size_t done = 0; to >= 0 && done < size; done += kMost)
    MPI_Isend(words.data() + done, static_cast<int>(std::min(kMost, size - done)), MPI_UINT64_T, to, kWords,
              MPI_COMM_WORLD, &requests.emplace_back());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t done = 0; done < all[i].size(); done += kMost)
      MPI_Recv(all[i].data() + done, static_cast<int>(std::min(kMost, all[i].size() - done)), MPI_UINT64_T, from[i],
               kWords, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return all;
}

std::string error_text(int error) {
  std::array<char, MPI_MAX_ERROR_STRING + 1> text{};
  int length = 0;
  MPI_Error_string(error, text.data(), &length);
  return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace blackleaf::mpi
