#pragma once

#include <array>
#include <cmath>

namespace weft {

/// A point [m] or a vector in double precision, for everything outside the kernels. y is up.
struct Vec3 {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;

    friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }

inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalized(Vec3 a) { return (1.0 / length(a)) * a; }

/// 3 x 3 matrix by rows.
struct Mat3 {
    std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

    friend bool operator==(const Mat3&, const Mat3&) = default;
};

inline Vec3 operator*(const Mat3& m, Vec3 v) {
    return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
}
inline Mat3 operator+(const Mat3& a, const Mat3& b) {
    return {{a.rows[0] + b.rows[0], a.rows[1] + b.rows[1], a.rows[2] + b.rows[2]}};
}
inline Mat3 operator*(double s, const Mat3& m) {
    return {{s * m.rows[0], s * m.rows[1], s * m.rows[2]}};
}
inline Mat3 transposed(const Mat3& m) {
    const auto& r = m.rows;
    return {
        {Vec3{r[0].x, r[1].x, r[2].x}, Vec3{r[0].y, r[1].y, r[2].y}, Vec3{r[0].z, r[1].z, r[2].z}}};
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
    const Mat3 t = transposed(b);
    Mat3 product;
    for (std::size_t i = 0; i < 3; ++i) {
        product.rows[i] = {dot(a.rows[i], t.rows[0]), dot(a.rows[i], t.rows[1]),
                           dot(a.rows[i], t.rows[2])};
    }
    return product;
}

/// Right-handed rotation about `axis` (any length but zero).
Mat3 rotation_matrix(Vec3 axis, double degrees);

}  // namespace weft
