#ifndef WEFT_KERNELS_CONTACT_FOUND_H
#define WEFT_KERNELS_CONTACT_FOUND_H

// One pair of a vertex and a triangle, or of two edges: how far apart they are, the plane between
// them, and how they push each other.

#include "kernels/contact/boxes.h"
#include "kernels/contact/closest.h"
#include "kernels/contact/rows.h"

/// With less of its stiffness than that, a contact does not push.
#define WEFT_LEAST_PART 0.01f

WEFT_KERNELS_BEGIN

/// What the scene says of contacts.
typedef struct {
    float range;      ///< where they begin to push [m]
    float slack;      ///< what planes leave between surfaces [m]
    float stiffness;  ///< of a contact, times the least of its vertices' [-]
} contact_settings;

/// The four vertices of a pair where it was found, and where inertia leads them.
typedef struct {
    real3 x0, x1, x2, x3;                 ///< [m]
    real3 way0, way1, way2, way3;         ///< [m]
    real moves0, moves1, moves2, moves3;  ///< 1, or 0 where held
    real least;                           ///< stiffness of one that moves [N/m]
} contact_pair;

/// The most that one of two vertices goes towards the other side; if both shall count, or the
/// first alone.
WEFT_INLINE real approach_of(real a, real b) { return larger(larger(a, b), splat(0.0f)); }

/// Where the plane between the two sides ends, from the closest point of B on, along n. Each side
/// gets what inertia asks for and half of what is left then, so that one which hardly moves can
/// still be pushed, or swing; where the gap is too small for that, both get a part of it by how
/// fast they come. What is led by the scene comes as far as it wants: the plane goes before it,
/// also over where the other side is, and that one keeps a reserve from it, lest the gap shrink
/// from substep to substep until nothing is left of it. (Where both are led through each other, it
/// goes between.)
/// distance     of the two sides [m]
/// a, b         the most that vertices of a side come nearer [m]
/// led_a, led_b  likewise, of held vertices alone
/// least        what is left to share where there is nothing [m]
/// reserve      no less than that, and no more than the distance [m]
WEFT_INLINE real plane_end(real distance, real a, real b, real led_a, real led_b, real least,
                           real reserve) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real own_a = a - led_a;
    const real own_b = b - led_b;
    const real left = distance - led_a - led_b;
    const real comes_a = led_a > zero ? (own_a + led_b > zero ? zero : one) : zero;
    const real comes_b = led_b > zero ? (own_b + led_a > zero ? zero : one) : zero;
    const real shared = larger(left, comes_a + comes_b > zero ? reserve : least);
    const real both_ways = own_a + own_b;
    const real spare = larger(shared - both_ways, zero);
    const real met = smaller(shared / larger(both_ways, splat(1e-12f)), one);
    const real asked = own_b * met + splat(0.5f) * spare;
    const real before_b = comes_b > zero ? larger(asked, reserve) : asked;
    const real wanted = comes_a > zero ? smaller(before_b, shared - reserve) : before_b;
    const real bounded = smaller(larger(wanted, splat(0.05f) * shared), splat(0.95f) * shared);
    const real too_far = smaller(left - shared, zero);
    const real part_of_a = led_a / larger(led_a + led_b, splat(1e-12f));
    return led_b + bounded + too_far * part_of_a;
}

/// How the two push each other.
typedef struct {
    real3 normal;  ///< from B to A
    real4 weights;
    real ahead;   ///< the gap where inertia leads [m]
    real spread;  ///< the sum of |w| of vertices that move
} contact_push;

/// A contact as all of its vertices see it.
typedef struct {
    real3 normal;   ///< from B to A, where the two are found
    real distance;  ///< [m]
    real4 room;     ///< of each vertex before its plane [m]
    contact_push push;
    real stiffness;  ///< [N/m]; 0: it does not push
} contact_found;

/// The closest points. is_edges  1: x0 x1 and x2 x3 are edges; 0: x0 is a vertex, x1 x2 x3 a
/// triangle
WEFT_INLINE closest_points closest_of(contact_pair p, int is_edges) {
    return is_edges ? closest_edges(p.x0, p.x1, p.x2, p.x3)
                    : closest_vertex_triangle(p.x0, p.x1, p.x2, p.x3);
}

/// What changes its sign where one goes through the plane, or the line, of the other [m^3].
WEFT_INLINE real side_of(contact_pair p, int is_edges) {
    const real3 of_edges = cross3(subtract(p.x1, p.x0), subtract(p.x3, p.x2));
    const real3 of_face = cross3(subtract(p.x2, p.x1), subtract(p.x3, p.x1));
    return is_edges ? dot3(of_edges, subtract(p.x0, p.x2)) : dot3(of_face, subtract(p.x0, p.x1));
}

/// Where inertia leads.
WEFT_INLINE contact_pair led_pair(contact_pair p) {
    p.x0 = add(p.x0, p.way0);
    p.x1 = add(p.x1, p.way1);
    p.x2 = add(p.x2, p.way2);
    p.x3 = add(p.x3, p.way3);
    return p;
}

/// 1 where the closest points are inside of a triangle.
WEFT_INLINE whole is_on_face(real4 w, int is_edges) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole z = w.z != zero ? (w.w != zero ? splat_whole(1) : none) : none;
    return is_edges ? none : (w.y != zero ? z : none);
}

/// 1 where nothing speaks against closest points where inertia leads: no way through each other.
/// Either the direction is nearly the same; or the two are on the same side of each other, and not
/// so near that their direction may be any.
WEFT_INLINE whole is_led_past(contact_pair found, contact_pair led, closest_points then,
                              real3 normal, real near, int is_edges) {
    const whole one = splat_whole(1);
    const whole none = splat_whole(0);
    const real length = square_root(then.square);
    // Not their product: that of small volumes is zero.
    const real side = side_of(found, is_edges);
    const real led_side = side_of(led, is_edges);
    const real zero = splat(0.0f);
    const real alike = larger(smaller(side, led_side), -larger(side, led_side));
    const whole past = alike > zero ? (length > splat(0.5f) * near ? one : none) : none;
    return dot3(then.way, normal) > splat(0.25f) * length ? one : past;
}

/// Forces are those where the substep ends. What slides along a surface comes to edges and corners
/// that were before it, and lies on them then: seen from where it was, it would run into them, and
/// be braked, and lifted. So the direction is that where inertia leads, but of faces, which are
/// planes: what slides on over their edge comes to one beside it.
/// closest, normal, distance  where the two are found
WEFT_INLINE contact_push push_of(contact_pair p, closest_points closest, real3 normal,
                                 real distance, real range, int is_edges) {
    const contact_pair led = led_pair(p);
    const closest_points then = closest_of(led, is_edges);
    const whole past = is_led_past(p, led, then, normal, smaller(distance, range), is_edges);
    const mask there =
        past * (splat_whole(1) - is_on_face(closest.weights, is_edges)) > splat_whole(0);
    const real4 w = closest.weights;
    const real length = square_root(then.square);
    const real shrink = splat(1.0f) / divisor(length);
    const real gap = distance + (w.x * dot3(normal, p.way0) + w.y * dot3(normal, p.way1) +
                                 w.z * dot3(normal, p.way2) + w.w * dot3(normal, p.way3));
    contact_push push;
    push.normal.x = there ? then.way.x * shrink : normal.x;
    push.normal.y = there ? then.way.y * shrink : normal.y;
    push.normal.z = there ? then.way.z * shrink : normal.z;
    push.weights.x = there ? then.weights.x : w.x;
    push.weights.y = there ? then.weights.y : w.y;
    push.weights.z = there ? then.weights.z : w.z;
    push.weights.w = there ? then.weights.w : w.w;
    push.ahead = there ? length : gap;
    push.spread = size_of(push.weights.x) * p.moves0 + size_of(push.weights.y) * p.moves1 +
                  size_of(push.weights.z) * p.moves2 + size_of(push.weights.w) * p.moves3;
    return push;
}

/// Which part of its stiffness two edges' contact has: it fades to nothing within a length of an
/// edge's end. Surfaces that lie on each other cross at many edges, and as they slide, crossings
/// come and go over ends. Did they at once, each would be a spring that is there, compressed, or is
/// no more: of both, what is lost or won becomes motion, and sheets that lie on each other heated
/// up. At an end it is the vertex there that meets the other surface, as a pair of its own.
/// w  of the four ends
WEFT_INLINE real edges_part(contact_pair p, real4 w, real length) {
    const real one = splat(1.0f);
    const real first = smaller(size_of(w.x), size_of(w.y)) * length3(subtract(p.x1, p.x0));
    const real second = smaller(size_of(w.z), size_of(w.w)) * length3(subtract(p.x3, p.x2));
    const real part = smaller(first / length, one) * smaller(second / length, one);
    return part < splat(WEFT_LEAST_PART) ? splat(0.0f) : part;
}

/// is_edges  as in closest_of
WEFT_INLINE contact_found find_contact(contact_pair p, int is_edges, contact_settings settings) {
    const real zero = splat(0.0f);
    const closest_points closest = closest_of(p, is_edges);
    contact_found f;
    const real4 w = closest.weights;
    f.distance = square_root(closest.square);
    f.normal = scale(closest.way, splat(1.0f) / divisor(f.distance));
    const real go0 = dot3(f.normal, p.way0);
    const real go1 = dot3(f.normal, p.way1);
    const real go2 = dot3(f.normal, p.way2);
    const real go3 = dot3(f.normal, p.way3);
    f.push = push_of(p, closest, f.normal, f.distance, splat(settings.range), is_edges);
    f.stiffness = splat(settings.stiffness) * p.least;
    if (is_edges) {
        f.stiffness = f.stiffness * edges_part(p, f.push.weights, splat(0.7f * settings.range));
    }

    // Heights over x0 along n: of the corners, and of the closest points.
    const real h1 = dot3(f.normal, subtract(p.x1, p.x0));
    const real h2 = dot3(f.normal, subtract(p.x2, p.x0));
    const real h3 = dot3(f.normal, subtract(p.x3, p.x0));
    const real led0 = (splat(1.0f) - p.moves0) * go0;
    const real led1 = (splat(1.0f) - p.moves1) * go1;
    const real led2 = (splat(1.0f) - p.moves2) * go2;
    const real led3 = (splat(1.0f) - p.moves3) * go3;
    const real b23 = approach_of(go2, go3);
    const real led23 = approach_of(led2, led3);
    const real least = smaller(splat(settings.slack), splat(0.25f) * f.distance);
    const real reserve = smaller(splat(settings.slack), f.distance);
    if (is_edges) {
        const real end = plane_end(f.distance, approach_of(-go0, -go1), b23,
                                   approach_of(-led0, -led1), led23, least, reserve);
        const real top = w.y * h1;
        const real over = f.distance - end - top;
        const real under = end - w.z * h2 - w.w * h3;
        f.room.x = over;
        f.room.y = over + h1;
        f.room.z = under - h2;
        f.room.w = under - h3;
    } else {
        const real end = plane_end(f.distance, approach_of(-go0, zero), larger(b23, go1),
                                   approach_of(-led0, zero), larger(led23, led1), least, reserve);
        const real under = end - w.y * h1 - w.z * h2 - w.w * h3;
        f.room.x = f.distance - end;
        f.room.y = under - h1;
        f.room.z = under - h2;
        f.room.w = under - h3;
    }
    return f;
}

WEFT_KERNELS_END

#endif
