//! `worn.rs` and `repair.rs`: clothes of copies of a trunk, and a belly that grows into them.

use crate::clothes::Winding;
use crate::people::{Person, Shape};
use crate::tubes::add_mesh;
use glam::DVec3;
use std::collections::BTreeMap;
use superdeform::internals::geometry::weld::{SEAM, Weld, weld};
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::repair::Pushed;
use superdeform::internals::shape::product::worn::Worn;
use superdeform::{Character, MeshKind};

/// A person in shirts that lie so far from the trunk.
struct Dressed {
    person: Person,
    character: Character,
    figure: Figure,
    weld: Weld,
    worn: Worn,
}

impl Dressed {
    fn of(gaps: &[f64], is_named: bool) -> Self {
        let person = Person { blended: true, columns: 48, ..Person::adult() };
        let mut character = person.build();
        for &gap in gaps {
            let shirt = shirt(&person, &character, gap);
            add_mesh(&mut character, "shirt", MeshKind::Garment, &shirt, 0);
            if !is_named {
                character.meshes.last_mut().unwrap().kind = None;
            }
        }
        let figure = Figure::of(&character).unwrap();
        let weld = weld(&figure.positions, SEAM * figure.height());
        let kinds: Vec<bool> = character
            .meshes
            .iter()
            .flat_map(|mesh| mesh.positions.iter().map(|_| mesh.kind.is_some()))
            .collect();
        let worn = Worn::of(&figure, |vertex| kinds[vertex], &weld, 1);
        Self { person, character, figure, weld, worn }
    }

    fn mesh(&self, index: usize) -> std::ops::Range<usize> {
        self.figure.mesh_starts[index]..self.figure.mesh_starts[index + 1]
    }

    fn shirts(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.character.meshes.len()).filter(|&mesh| self.character.meshes[mesh].name == "shirt")
    }

    /// Where all is once the belly has grown by `size`; clothes stay.
    fn grown(&self, size: f64) -> Vec<DVec3> {
        let middle = 0.5 * (self.person.crotch() + self.person.shoulder_line());
        let mut after = self.figure.positions.clone();
        for vertex in self.mesh(0) {
            let p = after[vertex];
            let from = DVec3::new(p.x, (p.y - middle) * 1.5, p.z - self.person.proportions.torso_radius);
            let near = (-(from.length() / (0.7 * self.person.proportions.torso_radius)).powi(2)).exp();
            after[vertex] += size * near * DVec3::new(p.x, 0.0, p.z).normalize_or_zero();
        }
        after
    }

    fn pushed(&self, after: &[DVec3]) -> Pushed {
        self.worn.pushed(after, &self.weld, self.figure.height(), 1).unwrap()
    }

    fn winding(&self, points: &[DVec3]) -> Winding {
        let body: Vec<[DVec3; 3]> = self.character.meshes[0]
            .triangles
            .iter()
            .map(|corners| corners.map(|vertex| points[vertex as usize]))
            .collect();
        Winding::new(&body)
    }

    /// `after` with the push.
    fn with(&self, after: &[DVec3], pushed: &Pushed) -> Vec<DVec3> {
        let mut to = after.to_vec();
        for &(vertex, offset) in &pushed.offsets {
            to[vertex as usize] += offset;
        }
        to
    }
}

/// A copy of the trunk's middle, `gap` outside of it.
fn shirt(person: &Person, character: &Character, gap: f64) -> Shape {
    let body = &character.meshes[0];
    let p = |vertex: u32| body.positions[vertex as usize].as_dvec3();
    let is_of_trunk = |vertex: u32| {
        let p = p(vertex);
        p.y > person.crotch() + 0.08
            && p.y < person.shoulder_line() - 0.08
            && p.x.hypot(p.z) < 1.2 * person.proportions.torso_radius
    };
    let mut shape = Shape { columns: 48, ..Shape::default() };
    let mut index_of: BTreeMap<u32, u32> = BTreeMap::new();
    for corners in body.triangles.iter().filter(|corners| corners.iter().all(|&v| is_of_trunk(v))) {
        let corners = corners.map(|vertex| {
            *index_of.entry(vertex).or_insert_with(|| {
                let p = p(vertex);
                shape.positions.push(p + gap * DVec3::new(p.x, 0.0, p.z).normalize());
                shape.positions.len() as u32 - 1
            })
        });
        shape.triangles.push(corners);
    }
    assert!(shape.triangles.len() > 500, "{}", shape.triangles.len());
    shape
}

#[test]
fn clothes_that_nothing_enters_stay() {
    let dressed = Dressed::of(&[0.004], true);
    assert!(dressed.worn.places.len() > 300);
    assert_eq!(dressed.pushed(&dressed.figure.positions), Pushed::default());
    // All becomes half as large.
    let half: Vec<DVec3> = dressed.figure.positions.iter().map(|&p| 0.5 * p).collect();
    assert_eq!(
        dressed.worn.pushed(&half, &dressed.weld, 0.5 * dressed.figure.height(), 1).unwrap(),
        Pushed::default()
    );
}

#[test]
fn a_belly_that_grows_pushes_the_shirt_out_and_nothing_else() {
    for size in [0.006, 0.015, 0.03] {
        let dressed = Dressed::of(&[0.004], true);
        let after = dressed.grown(size);
        let (before, winding) = (dressed.winding(&dressed.figure.positions), dressed.winding(&after));
        let pushed = dressed.pushed(&after);
        let to = dressed.with(&after, &pushed);
        let shirt = dressed.mesh(dressed.shirts().next().unwrap());
        let was_outside = |&vertex: &usize| before.at(dressed.figure.positions[vertex]) < 0.5;
        let inside = |points: &[DVec3]| {
            shirt.clone().filter(was_outside).filter(|&vertex| winding.at(points[vertex]) > 0.5).count()
        };
        assert!(inside(&after) > 10, "{size}: the belly enters at {} vertices", inside(&after));
        assert_eq!(inside(&to), 0, "{size}");
        let only_cloth = pushed.offsets.iter().all(|&(vertex, _)| shirt.contains(&(vertex as usize)));
        assert!(only_cloth, "something else moves");
        // Not further than the belly and half of the gap, and not behind the back.
        for &(vertex, offset) in &pushed.offsets {
            assert!(offset.length() <= size + 0.004, "{size}: {offset}");
            assert!(
                after[vertex as usize].z > -0.5 * dressed.person.proportions.torso_radius,
                "{}",
                after[vertex as usize]
            );
        }
    }
}

#[test]
fn no_triangle_turns_over_and_none_is_torn() {
    for size in [0.006, 0.03, 0.06] {
        let dressed = Dressed::of(&[0.004, 0.01], true);
        let after = dressed.grown(size);
        let to = dressed.with(&after, &dressed.pushed(&after));
        for mesh in dressed.shirts() {
            let start = dressed.figure.mesh_starts[mesh];
            for corners in &dressed.character.meshes[mesh].triangles {
                let normal = |points: &[DVec3]| {
                    let [a, b, c] = corners.map(|vertex| points[start + vertex as usize]);
                    (b - a).cross(c - a)
                };
                assert!(normal(&after).dot(normal(&to)) > 0.0, "{size}: {corners:?} turned over");
            }
        }
    }
}

#[test]
fn a_coat_stays_over_the_shirt() {
    for size in [0.01, 0.02] {
        let dressed = Dressed::of(&[0.003, 0.006], true);
        let after = dressed.grown(size);
        let to = dressed.with(&after, &dressed.pushed(&after));
        let [shirt, coat] = [0, 1].map(|index| dressed.mesh(dressed.shirts().nth(index).unwrap()));
        let mut moved = 0;
        for (inner, outer) in shirt.zip(coat) {
            let way = (after[outer] - after[inner]).normalize();
            assert!((to[outer] - to[inner]).dot(way) > 0.0, "{size}: {} is under the shirt", to[outer]);
            moved += usize::from(to[inner] != after[inner]);
        }
        assert!(moved > 20, "{moved}");
    }
}

#[test]
fn a_shirt_without_a_name_is_worn_where_it_lies_over_the_body() {
    let named = Dressed::of(&[0.004], true);
    let unnamed = Dressed::of(&[0.004], false);
    assert_eq!(unnamed.worn.places, named.worn.places);
    // So far away it is no shirt.
    assert!(Dressed::of(&[0.12], false).worn.places.is_empty());
}

#[test]
fn a_mirrored_person_keeps_the_mirrored_shirt() {
    let dressed = Dressed::of(&[0.004], true);
    let mirror = |p: &DVec3| DVec3::new(-p.x, p.y, p.z);
    let mut figure = dressed.figure.clone();
    figure.positions = figure.positions.iter().map(mirror).collect();
    // The winding stays: the body looks inwards now.
    let worn = Worn::of(&figure, |_| true, &dressed.weld, 1);
    assert_eq!(worn.outwards, -dressed.worn.outwards);
    let after = dressed.grown(0.015);
    let mirrored: Vec<DVec3> = after.iter().map(mirror).collect();
    let (plain, other) =
        (dressed.pushed(&after), worn.pushed(&mirrored, &dressed.weld, figure.height(), 1).unwrap());
    assert_eq!(plain.offsets.len(), other.offsets.len());
    for ((vertex, offset), (same, back)) in plain.offsets.iter().zip(&other.offsets) {
        assert!(vertex == same && offset.distance(mirror(back)) < 1e-9, "{vertex}: {offset}, {back}");
    }
}

/// A body that ends above the middle of its shirt, as those do without skin under their clothes.
#[test]
fn cloth_is_inside_where_it_went_through_the_body_and_not_where_it_is_before_a_hole_of_it() {
    let mut dressed = Dressed::of(&[0.004], true);
    let middle = 0.5 * (dressed.person.crotch() + dressed.person.shoulder_line());
    let shirt = dressed.mesh(dressed.shirts().next().unwrap());
    let drawn_in = |p: DVec3, by: f64| p - by * DVec3::new(p.x, 0.0, p.z).normalize();
    for vertex in shirt.clone() {
        let p = &mut dressed.figure.positions[vertex];
        *p = if p.y < middle { drawn_in(*p, 0.04) } else { *p };
    }
    let before = dressed.figure.clone();
    let is_whole = |corners: &[u32; 3]| {
        corners
            .iter()
            .all(|&vertex| shirt.contains(&(vertex as usize)) || before.positions[vertex as usize].y > middle)
    };
    dressed.figure.triangles.retain(is_whole);
    let worn = Worn::of(&dressed.figure, |_| true, &dressed.weld, 1);
    let moved = |to: &dyn Fn(DVec3) -> DVec3| {
        let mut after = dressed.figure.clone();
        shirt.clone().for_each(|vertex| after.positions[vertex] = to(after.positions[vertex]));
        let [inside] = worn.newly_inside(&dressed.figure, &after, [&[]], 1);
        inside
    };
    // Up to the hole and a little into it.
    let near = |p: DVec3| (middle - 0.06..middle).contains(&p.y);
    assert_eq!(moved(&|p| if near(p) { p.with_y(middle + 0.012) } else { p }), 0.0);
    let share = shirt.clone().filter(|&vertex| before.positions[vertex].y > middle).count() as f64
        / shirt.len() as f64;
    let inside = moved(&|p| if p.y > middle { drawn_in(p, 0.02) } else { p });
    assert!((inside - share).abs() < 0.1, "{inside} of {share}");
}

#[test]
fn threads_change_no_bit_of_a_push() {
    let dressed = Dressed::of(&[0.004, 0.01], true);
    let after = dressed.grown(0.02);
    let one = dressed.pushed(&after);
    assert!(!one.offsets.is_empty());
    for threads in [2, 5] {
        assert_eq!(
            dressed.worn.pushed(&after, &dressed.weld, dressed.figure.height(), threads).unwrap(),
            one
        );
    }
}
