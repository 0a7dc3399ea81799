//! `strands.rs` and `hanging.rs`: kinds of hair on an adult and on a super-deformed figure, made like one.

use crate::clothes::Winding;
use crate::common_hair::{KINDS, Kind, vertices, with_hair};
use crate::people::Person;
use glam::DVec3;
use std::sync::{Arc, OnceLock};
use superdeform::internals::shape::Measured;
use superdeform::{Character, Deformer, MeshKind, Options, Style};

/// A figure with hair, and what came out of it.
struct Made {
    name: String,
    person: Person,
    kind: Kind,
    character: Character,
    deformer: Deformer,
    before: Vec<DVec3>,
    after: Vec<DVec3>,
    /// Corners over all meshes, of hair alone.
    hair: Vec<[usize; 3]>,
    body: Vec<[usize; 3]>,
    /// How much the head grew.
    scale: f64,
}

fn person(proportions: Person) -> Person {
    Person { blended: true, columns: 24, ..proportions }
}

fn styled(options: &Options) -> Style {
    Style::Shape(Box::new(Measured::of(&person(Person::chibi()).build(), options).unwrap().shape))
}

fn make(person: &Person, kind: Kind, options: &Options) -> Made {
    let character = with_hair(person, kind);
    let deformer = Deformer::new(Arc::new(character.clone()), &styled(options), options).unwrap();
    let result = character.with(&deformer.apply());
    let positions = |character: &Character| -> Vec<DVec3> {
        character.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|p| p.as_dvec3())).collect()
    };
    let of_hair = vertices(&character, person, kind);
    let mut start = 0;
    let (mut hair, mut body) = (Vec::new(), Vec::new());
    for mesh in &character.meshes {
        for corners in mesh.triangles.iter().map(|corners| corners.map(|corner| start + corner as usize)) {
            if corners.iter().all(|corner| of_hair.contains(corner)) {
                hair.push(corners);
            } else if mesh.kind == Some(MeshKind::Body) {
                body.push(corners);
            }
        }
        start += mesh.positions.len();
    }
    let (before, after) = (positions(&character), positions(&result));
    let top = |points: &[DVec3]| {
        let all = || {
            of_hair.clone().filter(|&vertex| before[vertex].y > person.chin() + 0.5 * person.proportions.head)
        };
        let low = all().map(|vertex| points[vertex].y).fold(f64::INFINITY, f64::min);
        all().map(|vertex| points[vertex].y).fold(f64::NEG_INFINITY, f64::max) - low
    };
    let scale = top(&after) / top(&before);
    Made {
        name: format!(
            "{kind:?} on {}",
            if person.proportions.head > 0.4 { "an SD figure" } else { "an adult" }
        ),
        person: person.clone(),
        kind,
        character,
        deformer,
        before,
        after,
        hair,
        body,
        scale,
    }
}

fn all() -> &'static [Made] {
    static ALL: OnceLock<Vec<Made>> = OnceLock::new();
    ALL.get_or_init(|| {
        let people = [Person::adult(), Person::chibi()].map(person);
        let made = |person: &Person| KINDS.map(|kind| make(person, kind, &Options::default()));
        people.iter().flat_map(made).collect()
    })
}

impl Made {
    /// True for the super-deformed figure.
    fn is_small(&self) -> bool {
        self.person.proportions.head > 0.4
    }

    fn turned(&self) -> usize {
        let normal =
            |points: &[DVec3], [a, b, c]: [usize; 3]| (points[b] - points[a]).cross(points[c] - points[a]);
        let is_turned =
            |corners: &&[usize; 3]| normal(&self.before, **corners).dot(normal(&self.after, **corners)) < 0.0;
        self.hair.iter().filter(is_turned).count()
    }

    /// The share of the hair's vertices that are in the body and were not.
    fn newly_inside(&self) -> f64 {
        let winding = |points: &[DVec3]| {
            Winding::new(
                &self.body.iter().map(|corners| corners.map(|corner| points[corner])).collect::<Vec<_>>(),
            )
        };
        let (before, after) = (winding(&self.before), winding(&self.after));
        let hair = vertices(&self.character, &self.person, self.kind);
        let count = hair
            .clone()
            .filter(|&vertex| after.at(self.after[vertex]) > 0.5 && before.at(self.before[vertex]) <= 0.5);
        count.count() as f64 / hair.len() as f64
    }

    /// The least and the greatest length of an edge of hair, against what the head makes of it.
    fn stretch(&self) -> [f64; 2] {
        let edges = self.hair.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let ratio = |[a, b]: [usize; 2]| {
            self.after[a].distance(self.after[b]) / (self.scale * self.before[a].distance(self.before[b]))
        };
        edges
            .map(ratio)
            .fold([f64::INFINITY, 0.0], |[least, most], ratio| [least.min(ratio), most.max(ratio)])
    }
}

#[test]
fn hair_does_not_turn_over() {
    for made in all() {
        let most = if made.is_small() { 0 } else { made.hair.len() / 1000 };
        assert!(made.turned() <= most, "{}: {} triangles are turned over", made.name, made.turned());
    }
}

#[test]
fn hair_stays_outside_of_the_body() {
    for made in all() {
        let most = if made.is_small() { 0.003 } else { 0.015 };
        assert!(made.newly_inside() <= most, "{}: {} is inside", made.name, made.newly_inside());
    }
}

/// Where hair is made shorter, edges across it keep their length, those along it at least a tenth of it. On a figure that has as few
/// heads already hair is as it was drawn.
#[test]
fn no_shelf_and_no_tear_is_in_hair() {
    for made in all() {
        let [least, most] = made.stretch();
        let (shortest, longest) = if made.is_small() { (0.65, 1.2) } else { (0.1, 2.2) };
        assert!(
            least > shortest && most < longest,
            "{}: edges are {least} to {most} times as long",
            made.name
        );
    }
}

#[test]
fn hair_ends_where_it_ended_on_the_body_or_at_the_chin() {
    let person = person(Person::adult());
    for (hair_length, share) in [(1.0, 1.0), (0.5, 0.5), (0.0, 0.0)] {
        let made = make(&person, Kind::Straight, &Options { hair_length, ..Options::default() });
        let measured = made.deformer.target();
        let chin = measured.anatomy.landmarks.heights.chin;
        let lowest =
            |points: &[DVec3]| made.hair.iter().flatten().map(|&v| points[v].y).fold(f64::INFINITY, f64::min);
        // Half a head length around what the trunk's own skin at that height and the chin say.
        let place = |y: f64| {
            let is_near = |v: &usize| (made.before[*v].y - y).abs() < 0.02 && made.before[*v].x.abs() < 0.14;
            let near: Vec<f64> =
                made.body.iter().flatten().copied().filter(is_near).map(|v| made.after[v].y).collect();
            near.iter().sum::<f64>() / near.len() as f64
        };
        let (chin, end) = (place(chin + 0.02), place(lowest(&made.before)));
        let expected = chin + share * (end - chin);
        let head = made.scale * person.proportions.head;
        assert!(
            (lowest(&made.after) - expected).abs() < 0.5 * head,
            "{hair_length}: {} instead of {expected}",
            lowest(&made.after)
        );
    }
}

/// On an adult that becomes small: how far the hair's middle reaches behind the head's axis below the chin, against above the ears.
#[test]
fn draped_hair_hangs_straight_down_where_the_back_is_gone() {
    let made = all().iter().find(|made| made.kind == Kind::Draped && !made.is_small()).unwrap();
    let head = made.person.proportions.head;
    let furthest = |points: &[DVec3], from: f64, to: f64| {
        let is_there = |v: &usize| {
            let y = (made.before[*v].y - made.person.chin()) / head;
            (from..to).contains(&y) && made.before[*v].x.abs() < 0.1 * head
        };
        made.hair.iter().flatten().copied().filter(is_there).map(|v| -points[v].z).fold(0.0, f64::max)
    };
    let leans = |points: &[DVec3]| furthest(points, -2.0, 0.0) / furthest(points, 0.4, 0.6);
    // As drawn it leans out by half; straight down it does not.
    assert!(leans(&made.before) > 1.4, "{}", leans(&made.before));
    assert!(leans(&made.after) < 1.06, "{}", leans(&made.after));
}

#[test]
fn joints_go_with_their_strands() {
    for made in all().iter().filter(|made| matches!(made.kind, Kind::TwinTails | Kind::OneTail | Kind::Braid))
    {
        let result = made.deformer.apply();
        let hair = vertices(&made.character, &made.person, made.kind);
        for (joint, after) in made
            .character
            .skeleton
            .joints
            .iter()
            .zip(&result.joints)
            .filter(|(joint, _)| joint.name.starts_with("hair_"))
        {
            let near = |points: &[DVec3], p: DVec3| {
                hair.clone().map(|v| points[v].distance(p)).fold(f64::INFINITY, f64::min)
            };
            // Within the lock as it was.
            let [was, is] = [near(&made.before, joint.position()), near(&made.after, *after)];
            assert!(
                (is - made.scale * was).abs() < 0.1 * made.scale * made.person.proportions.head,
                "{}, {}: {was} becomes {is}",
                made.name,
                joint.name
            );
        }
    }
}
