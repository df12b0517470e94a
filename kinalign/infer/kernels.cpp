// SPDX-License-Identifier: Apache-2.0
// This file is compiled twice: CMakeLists.txt sets KA_KERNELS to the name of the build. The file
// includes no header with inline functions. The linker would keep one copy of such a function for
// both builds, and a processor without AVX2 could then run AVX2 code.
#include "kinalign/infer/kernels.h"

namespace kinalign::KA_KERNELS {

extern const Kernels kernels;

namespace {

using std::size_t;

#ifdef __AVX2__
// The tile sizes are chosen for 16 vector registers. With AVX2 a register has 8 floats, without it
// 4.
constexpr size_t lanes = 8;
constexpr size_t tile_rows = 6;    // 6 x 2 sums fit into 12 of 16 registers
constexpr size_t tile_panels = 4;  // for a single frame: 4 x 2 sums
#else
constexpr size_t lanes = 4;
constexpr size_t tile_rows = 2;
constexpr size_t tile_panels = 2;
#endif
constexpr size_t row_block = 96;  // frames that stay in the cache while all panels are processed

// Vectors that hold the outputs of one panel.
constexpr size_t panel_vectors = panel_width / lanes;

// A vector type of GCC and Clang.
using Vector [[gnu::vector_size(lanes * sizeof(float))]] = float;

// Inlining is forced, because the sums of a tile stay in registers only within one function.
#define KA_INLINE inline __attribute__((always_inline))

/// Loads and stores at any address, aligned or not.
KA_INLINE Vector vector_at(const float* values) {
  Vector out;
  __builtin_memcpy(&out, values, sizeof out);
  return out;
}
KA_INLINE void put(const Vector& vector, float* values) {
  __builtin_memcpy(values, &vector, sizeof vector);
}

// ---- products

/// Adds one channel of one tap to the sums: sums[r,j] += in[r in_stride] w[j].
template <size_t Rows, size_t Vectors>
KA_INLINE void add_channel(Vector (&sums)[Rows][Vectors], const float* in, size_t in_stride,
                           const Vector (&w)[Vectors]) {
#pragma GCC unroll 6
  for (size_t r = 0; r < Rows; ++r) {
    const float x = in[r * in_stride];
#pragma GCC unroll 16
    for (size_t j = 0; j < Vectors; ++j) sums[r][j] += x * w[j];
  }
}

template <size_t Rows, size_t Vectors>
KA_INLINE void load(Vector (&sums)[Rows][Vectors], const float* from) {
#pragma GCC unroll 24
  for (size_t i = 0; i < Rows * Vectors; ++i)
    sums[i / Vectors][i % Vectors] = vector_at(from + i * lanes);
}

template <size_t Rows, size_t Vectors>
KA_INLINE void store(const Vector (&sums)[Rows][Vectors], float* to) {
#pragma GCC unroll 24
  for (size_t i = 0; i < Rows * Vectors; ++i) put(sums[i / Vectors][i % Vectors], to + i * lanes);
}

/// Adds the products of the frames from t on with the panels from `first` on to `values`
/// [Rows, Panels, panel_width]. The sums stay in registers.
template <size_t Rows, size_t Panels>
KA_INLINE void sum_tile(const Product& p, size_t t, size_t first, float* values) {
  constexpr size_t vectors = Panels * panel_vectors;
  const size_t depth = p.taps * p.channels;
  const float* weights = p.weights + first * depth * panel_width;
  Vector sums[Rows][vectors];
  load(sums, values);
  for (size_t k = 0; k < p.taps; ++k) {
    const float* in = p.in + t * p.in_stride + k * p.tap_stride;
    for (size_t c = 0; c < p.channels; ++c, weights += panel_width) {
      Vector w[vectors];
#pragma GCC unroll 16
      for (size_t j = 0; j < vectors; ++j) {
        w[j] = vector_at(weights + j / panel_vectors * depth * panel_width +
                         j % panel_vectors * lanes);
      }
      add_channel(sums, in + c, p.in_stride, w);
    }
  }
  store(sums, values);
}

/// Like sum_tile(), but starts from the bias (or from `out`) and handles outputs that end within
/// the last panel.
template <size_t Rows, size_t Panels>
void tile(const Product& p, size_t t, size_t first) {
  constexpr size_t width = Panels * panel_width;
  const size_t begin = first * panel_width;
  const size_t left = p.outputs - begin;
  const size_t n = left < width ? left : width;
  float* out = p.out + t * p.out_stride + begin;
  // Padded outputs of the last panel are summed too, with weights of 0, and are not copied out.
  float sums[Rows * width] = {};
  for (size_t r = 0; r < Rows; ++r) {
    // Without a bias the sums begin with the values of `out`, so a second product can be added to a
    // first one.
    const float* start = p.bias != nullptr ? p.bias + begin : out + r * p.out_stride;
    for (size_t i = 0; i < n; ++i) sums[r * width + i] = start[i];
  }
  sum_tile<Rows, Panels>(p, t, first, sums);
  for (size_t r = 0; r < Rows; ++r) {
    for (size_t i = 0; i < n; ++i) out[r * p.out_stride + i] = sums[r * width + i];
  }
}

/// Processes `rows` frames (fewer than a full tile) of one panel.
template <size_t Rows>
void last_rows(const Product& p, size_t t, size_t panel, size_t rows) {
  if constexpr (Rows > 0) {
    if (rows == Rows) {
      tile<Rows, 1>(p, t, panel);
    } else {
      last_rows<Rows - 1>(p, t, panel, rows);
    }
  }
}

// Works panel by panel over one block of frames. The weights of a panel are then read from memory
// once for all frames of the block.
void multiply_block(const Product& p, size_t from, size_t until) {
  for (size_t panel = 0; panel * panel_width < p.outputs; ++panel) {
    size_t t = from;
    for (; t + tile_rows <= until; t += tile_rows) tile<tile_rows, 1>(p, t, panel);
    last_rows<tile_rows - 1>(p, t, panel, until - t);
  }
}

// With a single frame each weight is used only once. Several panels are summed at once, so that all
// registers are in use.
void multiply_frame(const Product& p) {
  const size_t panels = (p.outputs + panel_width - 1) / panel_width;
  size_t panel = 0;
  for (; panel + tile_panels <= panels; panel += tile_panels) tile<1, tile_panels>(p, 0, panel);
  for (; panel < panels; ++panel) tile<1, 1>(p, 0, panel);
}

// Each output is summed in the order of taps and channels, whichever tile computes it. So a frame's
// result does not depend on the number of frames.
void multiply(const Product& p) {
  if (p.frames == 1) return multiply_frame(p);
  for (size_t from = 0; from < p.frames; from += row_block) {
    const size_t until = p.frames - from < row_block ? p.frames : from + row_block;
    multiply_block(p, from, until);
  }
}

// ---- functions of one value, written so that the compiler can vectorise loops over them

/// e^x, relative error below 2e-7. Method and coefficients: Cephes, expf.
KA_INLINE float exp_of(float x) {
  x = x < -87.0F ? -87.0F : x;  // NaN stays NaN
  x = x > 88.0F ? 88.0F : x;
  // Adding 1.5 * 2^23 puts the nearest whole number into the lowest bits.
  const float shifted = x * 1.44269504F + 12582912.0F;
  const float whole = shifted - 12582912.0F;
  // The constant ln 2 is split into two parts, so that the difference keeps its digits.
  const float r = (x - whole * 0.693359375F) + whole * 2.12194440e-4F;
  float p = 1.9875691500e-4F;
  p = p * r + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  p = p * r * r + r + 1.0F;
  // 2^whole is made from its bits: the exponent of a float begins at bit 23, with 127 for 2^0.
  const unsigned bits = __builtin_bit_cast(unsigned, shifted) + 127U;
  return p * __builtin_bit_cast(float, bits << 23U);
}

KA_INLINE float magnitude(float x) { return x < 0.0F ? -x : x; }

KA_INLINE float sigmoid_of(float x) { return 1.0F / (1.0F + exp_of(-x)); }

/// tanh x, as in Cephes (tanhf). Near 0 a polynomial is used, because the difference of two close
/// numbers would lose digits.
KA_INLINE float tanh_of(float x) {
  const float z = x * x;
  float p = -5.70498872745e-3F;
  p = p * z + 2.06390887954e-2F;
  p = p * z - 5.37397155531e-2F;
  p = p * z + 1.33314422036e-1F;
  p = p * z - 3.33332819422e-1F;
  const float near = p * z * x + x;
  // Both forms are computed and one is chosen, because a branch would prevent vectors.
  const float far = 1.0F - 2.0F / (exp_of(2.0F * x) + 1.0F);
  return magnitude(x) < 0.625F ? near : far;
}

/// x/2 (1 + erf(x/sqrt 2)). Abramowitz and Stegun 7.1.26 gives erfc with an error of 1.5e-7.
/// The same series serves both signs, because erfc(-z) = 2 - erfc(z).
KA_INLINE float gelu_of(float x) {
  const float z = magnitude(x) * 0.70710678F;
  const float t = 1.0F / (1.0F + 0.3275911F * z);
  float p = 1.061405429F;
  p = p * t - 1.453152027F;
  p = p * t + 1.421413741F;
  p = p * t - 0.284496736F;
  p = p * t + 0.254829592F;
  const float erfc = p * t * exp_of(-z * z);
  return 0.5F * x * (x < 0.0F ? erfc : 2.0F - erfc);
}

// NaN compares as false, so relu and leaky_relu pass it on.
void relu(float* values, size_t n) {
  for (size_t i = 0; i < n; ++i) values[i] = values[i] < 0.0F ? 0.0F : values[i];
}

void leaky_relu(float* values, size_t n, float slope) {
  for (size_t i = 0; i < n; ++i) values[i] = values[i] < 0.0F ? values[i] * slope : values[i];
}

void gelu(float* values, size_t n) {
  for (size_t i = 0; i < n; ++i) values[i] = gelu_of(values[i]);
}

void tanh(float* values, size_t n) {
  for (size_t i = 0; i < n; ++i) values[i] = tanh_of(values[i]);
}

void sigmoid(float* values, size_t n) {
  for (size_t i = 0; i < n; ++i) values[i] = sigmoid_of(values[i]);
}

void add(float* __restrict values, const float* __restrict more, size_t n) {
  for (size_t i = 0; i < n; ++i) values[i] += more[i];
}

void scale_by(float* __restrict values, const float* __restrict factors, size_t n) {
  for (size_t i = 0; i < n; ++i) values[i] *= factors[i];
}

// ---- sums over a frame

/// Sum of (value - mean)^Power, in `lanes` partial sums plus the remainder.
template <int Power>
KA_INLINE float sum_of(const float* values, size_t n, float mean) {
  Vector sums = {};
  size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    const Vector x = vector_at(values + i) - mean;
    sums += Power == 1 ? x : x * x;
  }
  float sum = 0.0F;
  for (; i < n; ++i) {
    const float x = values[i] - mean;
    sum += Power == 1 ? x : x * x;
  }
  // The remainder is added before the partial sums. Another order would change the last bits.
  for (size_t j = 0; j < lanes; ++j) sum += sums[j];
  return sum;
}

void layer_norm(const float* in, float* out, const float* weight, const float* bias,
                size_t channels) {
  const float n = static_cast<float>(channels);
  // The variance is computed from the differences to the mean: the difference of two large sums
  // would lose digits.
  const float mean = sum_of<1>(in, channels, 0.0F) / n;
  const float variance = sum_of<2>(in, channels, mean) / n;
  const float scale = 1.0F / __builtin_sqrtf(variance + 1e-5F);
  for (size_t i = 0; i < channels; ++i) out[i] = (in[i] - mean) * scale * weight[i] + bias[i];
}

// ---- gates

// PyTorch's equations: c = f c + i g, out = o tanh(c).
void lstm_gates(const float* __restrict gates, float* __restrict cell, float* __restrict out,
                size_t units) {
  for (size_t u = 0; u < units; ++u) {
    const float i = sigmoid_of(gates[u]), f = sigmoid_of(gates[units + u]);
    const float g = tanh_of(gates[2 * units + u]), o = sigmoid_of(gates[3 * units + u]);
    const float c = f * cell[u] + i * g;
    cell[u] = c;
    out[u] = o * tanh_of(c);
  }
}

/// `previous` and `out` are either the same or do not overlap, so no iteration depends on another.
void gru_gates(const float* from_input, const float* from_state, const float* previous, float* out,
               size_t units) {
#pragma GCC ivdep
  for (size_t u = 0; u < units; ++u) {
    const float r = sigmoid_of(from_input[u] + from_state[u]);
    const float z = sigmoid_of(from_input[units + u] + from_state[units + u]);
    // The reset gate acts after the product with the state, as in PyTorch.
    const float n = tanh_of(from_input[2 * units + u] + r * from_state[2 * units + u]);
    out[u] = (1.0F - z) * n + z * previous[u];
  }
}

// Two macros, because # does not expand its argument.
#define KA_TEXT(name) #name
#define KA_NAME(name) KA_TEXT(name)

}  // namespace

const Kernels kernels{
    KA_NAME(KA_KERNELS), multiply,   relu,     leaky_relu, gelu, tanh, sigmoid, add, scale_by,
    layer_norm,          lstm_gates, gru_gates};

}  // namespace kinalign::KA_KERNELS
