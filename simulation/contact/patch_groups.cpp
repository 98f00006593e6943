#include "simulation/contact/patch_groups.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "simulation/contact/notches.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void make_set(std::vector<int>& items) {
    std::ranges::sort(items);
    items.erase(std::ranges::unique(items).begin(), items.end());
}

class Groups {
public:
    Groups(const Surface& surface, const std::vector<int>& begin)
        : s_(surface), begin_(begin), root_(at(s_.vertex_count())) {
        for (int g = 0; g < count(); ++g) {
            groups_.of_patch.insert(groups_.of_patch.end(), at(begin_[at(g + 1)] - begin_[at(g)]),
                                    g);
            is_piece_.push_back(is_one_piece(g));
            is_inside_.push_back(!is_at_border(g));
            turns_.push_back(std::accumulate(surface.turns.begin() + begin_[at(g)],
                                             surface.turns.begin() + begin_[at(g + 1)], 0.0));
        }
    }

    PatchGroups find() {
        const std::vector<std::vector<int>> touching = this->touching();
        for (int g = 0; g < count(); ++g) {
            std::map<int, int> between;
            for (const int h : touching[at(g)]) {
                if (hang(g, h)) between.try_emplace(h, std::min(g, h));
            }
            for (const int via : touching[at(g)]) {
                for (const int h : touching[at(via)]) {
                    if (hang(g, via, h)) between.try_emplace(h, via);
                }
            }
            for (const auto& [h, via] : between) {
                groups_.beside.items.push_back(h);
                groups_.between.push_back(via);
            }
            groups_.beside.close();
        }
        return std::move(groups_);
    }

private:
    int count() const { return static_cast<int>(begin_.size()) - 1; }

    bool hang(int g, int h) const {
        const double other = g == h ? 0.0 : turns_[at(h)];
        return is_inside_[at(g)] || is_inside_[at(h)] || leave_no_slit(turns_[at(g)], 0.0, other);
    }

    bool hang(int g, int via, int h) const {
        const bool are_inside = is_inside_[at(via)] && (is_inside_[at(g)] || is_inside_[at(h)]);
        return are_inside || leave_no_slit(turns_[at(g)], turns_[at(via)], turns_[at(h)]);
    }

    template <class Use>
    void for_each_face(int group, Use use) const {
        for (int p = begin_[at(group)]; p < begin_[at(group + 1)]; ++p) {
            for (const int t : s_.faces[p]) use(t);
        }
    }

    /// Whether one of its faces has an edge that no other triangle has, or many.
    bool is_at_border(int group) const {
        bool is_border = false;
        for_each_face(group, [&](int t) {
            for (const int v : s_.beyond[at(t)]) is_border = is_border || v < 0;
        });
        return is_border;
    }

    int root(int vertex) {
        while (root_[at(vertex)] != vertex) vertex = root_[at(vertex)];
        return vertex;
    }

    /// Whether its faces hang together.
    bool is_one_piece(int group) {
        for_each_face(group, [&](int t) {
            for (const int v : s_.triangles[at(t)]) root_[at(v)] = v;
        });
        for_each_face(group, [&](int t) {
            const auto& [a, b, c] = s_.triangles[at(t)];
            root_[at(root(b))] = root(a);
            root_[at(root(c))] = root(a);
        });
        std::vector<int> pieces;
        for_each_face(group, [&](int t) { pieces.push_back(root(s_.triangles[at(t)][0])); });
        make_set(pieces);
        return pieces.size() == 1;
    }

    /// Pieces with a vertex in common, themselves too.
    std::vector<std::vector<int>> touching() const {
        std::vector<std::vector<int>> touching(at(count()));
        for (int v = 0; v < s_.vertex_count(); ++v) {
            std::vector<int> here;
            for (const int p : s_.patches_at[v]) {
                const int g = groups_.of_patch[at(p)];
                if (is_piece_[at(g)]) here.push_back(g);
            }
            make_set(here);
            for (const int g : here) {
                touching[at(g)].insert(touching[at(g)].end(), here.begin(), here.end());
            }
        }
        for (std::vector<int>& others : touching) make_set(others);
        return touching;
    }

    const Surface& s_;
    const std::vector<int>& begin_;
    std::vector<int> root_;  ///< [vertices] of pieces
    std::vector<bool> is_piece_, is_inside_;
    std::vector<double> turns_;  ///< as those of patches
    PatchGroups groups_;
};

}  // namespace

PatchGroups find_groups(const Surface& surface, const std::vector<int>& begin) {
    return Groups(surface, begin).find();
}

}  // namespace weft
