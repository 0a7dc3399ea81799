// Affine maps in doubles, column by column as superdeform.h has them.
#ifndef LINEAR_HPP
#define LINEAR_HPP

#include <array>
#include <cmath>

using Vector = std::array<double, 3>;

inline Vector operator+(const Vector &a, const Vector &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(const Vector &a, double scale) { return {a[0] * scale, a[1] * scale, a[2] * scale}; }
inline double length(const Vector &a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

struct Matrix {
  std::array<double, 16> n{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  bool operator==(const Matrix &other) const { return n == other.n; }

  Vector translation() const { return {n[12], n[13], n[14]}; }
  void set_translation(const Vector &to) {
    for (int i = 0; i < 3; i++) n[12 + i] = to[i];
  }

  // A displacement.
  Vector turn(const Vector &v) const {
    Vector turned{};
    for (int row = 0; row < 3; row++) turned[row] = n[row] * v[0] + n[4 + row] * v[1] + n[8 + row] * v[2];
    return turned;
  }
  // By the transpose: normals from the space that this leads to.
  Vector turn_transposed(const Vector &v) const {
    Vector turned{};
    for (int row = 0; row < 3; row++) turned[row] = n[4 * row] * v[0] + n[4 * row + 1] * v[1] + n[4 * row + 2] * v[2];
    return turned;
  }
  // A place.
  Vector move(const Vector &v) const { return turn(v) + translation(); }

  double determinant() const {
    return n[0] * (n[5] * n[10] - n[9] * n[6]) - n[4] * (n[1] * n[10] - n[9] * n[2]) +
           n[8] * (n[1] * n[6] - n[5] * n[2]);
  }

  Matrix inverse() const {
    const double d = determinant();
    Matrix inverted;
    for (int column = 0; column < 3; column++)
      for (int row = 0; row < 3; row++) {
        const int r1 = (column + 1) % 3, r2 = (column + 2) % 3, c1 = (row + 1) % 3, c2 = (row + 2) % 3;
        inverted.n[4 * column + row] = (n[4 * c1 + r1] * n[4 * c2 + r2] - n[4 * c2 + r1] * n[4 * c1 + r2]) / d;
      }
    inverted.set_translation(inverted.turn(translation()) * -1.0);
    return inverted;
  }

  // What the inverse's transpose does to directions: the map of normals.
  Matrix of_normals() const {
    const Matrix inverted = inverse();
    Matrix transposed;
    for (int column = 0; column < 3; column++)
      for (int row = 0; row < 3; row++) transposed.n[4 * column + row] = inverted.n[4 * row + column];
    return transposed;
  }
};

inline Matrix operator*(const Matrix &a, const Matrix &b) {
  Matrix product;
  for (int column = 0; column < 4; column++)
    for (int row = 0; row < 4; row++) {
      double sum = 0;
      for (int i = 0; i < 4; i++) sum += a.n[4 * i + row] * b.n[4 * column + i];
      product.n[4 * column + row] = sum;
    }
  return product;
}

inline Matrix from_parts(const Vector &translation, const std::array<double, 4> &rotation, const Vector &scale) {
  auto [x, y, z, w] = rotation;
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  if (size > 0) {
    x /= size, y /= size, z /= size, w /= size;
  } else {
    w = 1;
  }
  Matrix made;
  made.n = {(1 - 2 * (y * y + z * z)) * scale[0], 2 * (x * y + w * z) * scale[0],       2 * (x * z - w * y) * scale[0],       0,
            2 * (x * y - w * z) * scale[1],       (1 - 2 * (x * x + z * z)) * scale[1], 2 * (y * z + w * x) * scale[1],       0,
            2 * (x * z + w * y) * scale[2],       2 * (y * z - w * x) * scale[2],       (1 - 2 * (x * x + y * y)) * scale[2], 0,
            translation[0],                       translation[1],                       translation[2],                       1};
  return made;
}

#endif
