// The entropy coder against plain arithmetic, and the laws it rests on.
#include "file/nibble_coder.h"

#include <gtest/gtest.h>

#include <random>

#include "file/corner_model.h"

namespace blackleaf::detail {
namespace {

// A model as docs/FILE_FORMAT.md defines it.
struct PlainModel {
  std::array<int, 17> begins{};  // begins[16] = 2^14

  explicit PlainModel(const NibbleModel& model) {
    for (unsigned i = 0; i < 16; ++i) begins[i] = static_cast<int>(model.begin(i));
    begins[16] = 1 << 14;
  }
  void update(int symbol, int rate) {
    for (int i = 1; i < 16; ++i) {
      int& begin = begins[static_cast<std::size_t>(i)];
      const int target = i <= symbol ? 8 * i : (1 << 14) - 8 * (16 - i);
      int step = (target - begin) / (1 << rate);
      if (step * (1 << rate) > target - begin) --step;  // rounded down
      begin += step;
    }
  }
};

NibbleModel even_model() {
  std::array<int, 16> shares;
  shares.fill(1 << 10);
  return NibbleModel::of(shares);
}

TEST(NibbleCoder, ModelsAreWhatTheFormatSays) {
  std::mt19937 random(1);
  for (int rate = 2; rate <= 6; ++rate) {
    NibbleModel model = even_model();
    PlainModel plain(model);
    const unsigned common = random() % 16;
    for (int i = 0; i < 3000; ++i) {
      const auto symbol = static_cast<unsigned>(random() % 4 ? common : random() % 16);
      model.update(symbol, rate);
      plain.update(static_cast<int>(symbol), rate);
      for (unsigned s = 0; s < 16; ++s) {
        ASSERT_EQ(static_cast<int>(model.begin(s)), plain.begins[s]) << "rate " << rate << " step " << i;
        ASSERT_GE(plain.begins[s + 1] - plain.begins[s], 1);
        ASSERT_EQ(static_cast<int>(model.share(s)), plain.begins[s + 1] - plain.begins[s]);
        ASSERT_EQ(model.find(model.begin(s)), s);
        ASSERT_EQ(model.find(model.begin(s) + model.share(s) - 1), s);
      }
    }
  }
}

// Always the same symbol: every share ends at its floor, and none is lost.
TEST(NibbleCoder, SharesNeverVanish) {
  for (unsigned symbol = 0; symbol < 16; ++symbol)
    for (int rate = 2; rate <= 6; ++rate) {
      NibbleModel model = even_model();
      for (int i = 0; i < 5000; ++i) model.update(symbol, rate);
      for (unsigned s = 0; s < 16; ++s) ASSERT_GE(model.share(s), 1u) << symbol << " at " << rate << ": " << s;
      EXPECT_LE(model.share(symbol), kShares - 15);
    }
}

TEST(NibbleCoder, QuotientsByReciprocals) {
  std::mt19937_64 random(2);
  for (std::uint64_t share = 1; share < kShares; ++share)
    for (const std::uint64_t state :
         {share, share * 2 - 1, (share << 18) - 1, (share << 18) - share, (share << 18) / 2, random() % (share << 18)})
      ASSERT_EQ(state * nibble::kReciprocals[share] >> 46, state / share) << state << " / " << share;
}

TEST(NibbleCoder, RoundTrips) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const std::size_t length = random() % 500;
    std::vector<unsigned> symbols(length);
    const unsigned skew = 1 + random() % 16;
    for (auto& symbol : symbols) symbol = static_cast<unsigned>(random() % (random() % skew + 1));
    std::array<NibbleModel, 2> models = {even_model(), even_model()};
    NibbleEncoder encoder;
    encoder.make_room(length);
    for (std::size_t i = 0; i < length; ++i) encoder.symbol(models[i % 3 == 0], symbols[i], 5);
    auto bytes = encoder.finish();
    const std::size_t size = bytes.size();
    bytes.resize(size + NibbleDecoder::kPadding);
    models = {even_model(), even_model()};
    NibbleDecoder decoder({bytes.data(), size});
    for (std::size_t i = 0; i < length; ++i) {
      ASSERT_EQ(decoder.symbol(models[i % 3 == 0], 0, 5), symbols[i]);
      ASSERT_NO_THROW(decoder.check());
    }
    EXPECT_NO_THROW(decoder.expect_end());
  }
}

// Whoever reads on behind the last byte is told so.
TEST(NibbleCoder, EndsTooEarly) {
  std::vector<std::uint8_t> bytes(8 + NibbleDecoder::kPadding, 0);
  bytes[2] = bytes[6] = 1;  // both states 2^16, no bits
  NibbleDecoder decoder({bytes.data(), 8});
  NibbleModel model = even_model();
  EXPECT_NO_THROW(decoder.check());
  EXPECT_NO_THROW(decoder.expect_end());
  decoder.symbol(model, 0, 5);
  EXPECT_THROW(decoder.check(), Damage);
  EXPECT_THROW(decoder.expect_end(), Damage);
}

// The reader of docs/FILE_FORMAT.md, with 64-bit arithmetic and a search by hand.
TEST(NibbleCoder, PlainReader) {
  std::mt19937 random(4);
  NibbleModel model = even_model();
  NibbleEncoder encoder;
  std::vector<unsigned> symbols(2000);
  encoder.make_room(symbols.size());
  for (auto& symbol : symbols) encoder.symbol(model, symbol = static_cast<unsigned>(random() % (random() % 16 + 1)), 4);
  const auto bytes = encoder.finish();
  PlainModel plain(even_model());
  const auto number = [&](std::size_t at, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
    return value;
  };
  std::array<std::uint64_t, 2> states = {number(0, 4), number(4, 4)};
  std::size_t at = 8;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    std::uint64_t& state = states[i % 2];
    const auto slot = static_cast<int>(state % (1 << 14));
    int symbol = 0;
    while (plain.begins[static_cast<std::size_t>(symbol) + 1] <= slot) ++symbol;
    const int begin = plain.begins[static_cast<std::size_t>(symbol)];
    const int share = plain.begins[static_cast<std::size_t>(symbol) + 1] - begin;
    state = state / (1 << 14) * static_cast<std::uint64_t>(share) + static_cast<std::uint64_t>(slot - begin);
    if (state < 1 << 16) {
      state = state << 16 | number(at, 2);
      at += 2;
    }
    ASSERT_EQ(static_cast<unsigned>(symbol), symbols[i]) << i;
    plain.update(symbol, 4);
  }
  EXPECT_EQ(at, bytes.size());
  EXPECT_EQ(states[0], 1u << 16);
  EXPECT_EQ(states[1], 1u << 16);
}

// Every byte has one rank behind every faces, and ranks lead back to their bytes.
TEST(CornerModel, RanksAndBytes) {
  const CornerModel& model = CornerModel::get();
  EXPECT_EQ(model.context_count(), 376u);
  for (unsigned faces = 0; faces < 4096; ++faces) {
    unsigned listed = 0;
    for (unsigned byte = 0; byte < 256; ++byte) {
      const unsigned rank = model.rank(faces, byte);
      ASSERT_LE(rank, 15u);
      if (rank == 15) continue;
      ++listed;
      ASSERT_EQ(model.byte(faces, rank), byte);
    }
    ASSERT_EQ(listed, 15u);
  }
  for (const NibbleModel& shares : model.models())
    for (unsigned s = 0; s < 16; ++s) ASSERT_GE(shares.share(s), 24u);
}

// Behind white faces white is likeliest, behind black faces black; exchanging all colours exchanges what is likely.
TEST(CornerModel, ColoursAreAlike) {
  const CornerModel& model = CornerModel::get();
  EXPECT_EQ(model.rank(model.faces(0, 0, 0), 0x00), 0u);
  EXPECT_EQ(model.rank(model.faces(255, 255, 255), 0xFF), 0u);
  for (unsigned x = 0; x < 256; x += 5)
    for (unsigned y = 0; y < 256; y += 3)
      for (unsigned z = 0; z < 256; z += 7)
        ASSERT_EQ(model.context(model.faces(x, y, z)), model.context(model.faces(x ^ 255, y ^ 255, z ^ 255)));
}

}  // namespace
}  // namespace blackleaf::detail
