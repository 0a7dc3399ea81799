//! A small alphabet for captions: dots on a grid, joined to strokes and drawn smooth at any size.

use superdeform_host::image::Sheet;

/// Dots across a letter.
const COLUMNS: usize = 5;
/// Dots down a letter: seven above the line, two below it.
const ROWS: usize = 9;
/// Rows above the line.
const ASCENT: f32 = 6.0;

/// Letters by rows from the top; in a row, the highest of five bits is the leftmost dot.
#[rustfmt::skip]
const LETTERS: [(char, [u8; ROWS]); 42] = [
    ('a', [0, 0, 14, 1, 15, 17, 15, 0, 0]),       ('b', [16, 16, 30, 17, 17, 17, 30, 0, 0]),
    ('c', [0, 0, 14, 17, 16, 17, 14, 0, 0]),      ('d', [1, 1, 15, 17, 17, 17, 15, 0, 0]),
    ('e', [0, 0, 14, 17, 31, 16, 14, 0, 0]),      ('f', [6, 8, 28, 8, 8, 8, 8, 0, 0]),
    ('g', [0, 0, 15, 17, 17, 17, 15, 1, 14]),     ('h', [16, 16, 30, 17, 17, 17, 17, 0, 0]),
    ('i', [4, 0, 12, 4, 4, 4, 14, 0, 0]),         ('j', [2, 0, 6, 2, 2, 2, 2, 18, 12]),
    ('k', [16, 16, 17, 18, 28, 18, 17, 0, 0]),    ('l', [12, 4, 4, 4, 4, 4, 14, 0, 0]),
    ('m', [0, 0, 26, 21, 21, 21, 21, 0, 0]),      ('n', [0, 0, 30, 17, 17, 17, 17, 0, 0]),
    ('o', [0, 0, 14, 17, 17, 17, 14, 0, 0]),      ('p', [0, 0, 30, 17, 17, 17, 30, 16, 16]),
    ('q', [0, 0, 15, 17, 17, 17, 15, 1, 1]),      ('r', [0, 0, 22, 25, 16, 16, 16, 0, 0]),
    ('s', [0, 0, 15, 16, 14, 1, 30, 0, 0]),       ('t', [8, 8, 28, 8, 8, 8, 6, 0, 0]),
    ('u', [0, 0, 17, 17, 17, 17, 15, 0, 0]),      ('v', [0, 0, 17, 17, 17, 10, 4, 0, 0]),
    ('w', [0, 0, 21, 21, 21, 21, 10, 0, 0]),      ('x', [0, 0, 17, 10, 4, 10, 17, 0, 0]),
    ('y', [0, 0, 17, 17, 17, 17, 15, 1, 14]),     ('z', [0, 0, 31, 2, 4, 8, 31, 0, 0]),
    ('0', [14, 17, 17, 17, 17, 17, 14, 0, 0]),    ('1', [4, 12, 4, 4, 4, 4, 14, 0, 0]),
    ('2', [14, 17, 1, 2, 4, 8, 31, 0, 0]),        ('3', [14, 17, 1, 6, 1, 17, 14, 0, 0]),
    ('4', [2, 6, 10, 18, 31, 2, 2, 0, 0]),        ('5', [31, 16, 30, 1, 1, 17, 14, 0, 0]),
    ('6', [14, 16, 16, 30, 17, 17, 14, 0, 0]),    ('7', [31, 1, 2, 4, 4, 8, 8, 0, 0]),
    ('8', [14, 17, 17, 14, 17, 17, 14, 0, 0]),    ('9', [14, 17, 17, 15, 1, 1, 14, 0, 0]),
    ('.', [0, 0, 0, 0, 0, 0, 4, 0, 0]),           (',', [0, 0, 0, 0, 0, 0, 4, 8, 0]),
    ('-', [0, 0, 0, 0, 14, 0, 0, 0, 0]),          ('(', [2, 4, 4, 4, 4, 4, 2, 0, 0]),
    (')', [8, 4, 4, 4, 4, 4, 8, 0, 0]),           ('%', [24, 25, 2, 4, 8, 19, 3, 0, 0]),
];

/// Dots that a space takes.
const SPACE: usize = 3;

/// Draws `text` with its middle at `centre` and its foot on `line`, `dot` pixels from dot to dot; capitals come out
/// small, unknown letters as spaces.
pub fn draw(image: &mut Sheet, text: &str, centre: f32, line: f32, dot: f32, colour: [u8; 3]) {
    let letters: Vec<&[u8; ROWS]> = text
        .chars()
        .map(|letter| {
            let letter = letter.to_ascii_lowercase();
            LETTERS.iter().find(|(known, _)| *known == letter).map_or(&[0; ROWS], |(_, rows)| rows)
        })
        .collect();
    let dots: usize = letters.iter().map(|rows| extent(rows).1 + 1).sum();
    let mut left = centre - dots.saturating_sub(2) as f32 / 2.0 * dot;
    for rows in letters {
        let (first, count) = extent(rows);
        let corner = [left - first as f32 * dot, line - ASCENT * dot];
        draw_strokes(image, &strokes(rows), corner, dot, colour);
        left += (count + 1) as f32 * dot;
    }
}

/// The first column with a dot, and how many columns there are from it to the last.
fn extent(rows: &[u8; ROWS]) -> (usize, usize) {
    let columns = rows.iter().fold(0, |columns, row| columns | row);
    if columns == 0 {
        return (0, SPACE);
    }
    let first = columns.leading_zeros() as usize + COLUMNS - u8::BITS as usize;
    (first, COLUMNS - columns.trailing_zeros() as usize - first)
}

type Stroke = [[f32; 2]; 2];

/// Joins each dot with its neighbours; two dots are joined aslant only where no way round the corner exists.
fn strokes(rows: &[u8; ROWS]) -> Vec<Stroke> {
    let lit = |column: isize, row: isize| {
        (0..COLUMNS as isize).contains(&column)
            && (0..ROWS as isize).contains(&row)
            && rows[row as usize] >> (COLUMNS as isize - 1 - column) & 1 == 1
    };
    let mut strokes = Vec::new();
    for row in 0..ROWS as isize {
        for column in 0..COLUMNS as isize {
            if !lit(column, row) {
                continue;
            }
            let here = [column as f32, row as f32];
            // A dot alone is a stroke without length.
            strokes.push([here, here]);
            for (right, down) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
                let (next_column, next_row) = (column + right, row + down);
                let aslant = right != 0 && down != 0;
                let around = aslant && (lit(next_column, row) || lit(column, next_row));
                if lit(next_column, next_row) && !around {
                    strokes.push([here, [next_column as f32, next_row as f32]]);
                }
            }
        }
    }
    strokes
}

fn draw_strokes(image: &mut Sheet, strokes: &[Stroke], corner: [f32; 2], dot: f32, colour: [u8; 3]) {
    let half_width = 0.42 * dot;
    let last_row = corner[1] + ROWS as f32 * dot;
    let last_column = corner[0] + COLUMNS as f32 * dot;
    for y in ((corner[1] - dot).max(0.0) as u32)..((last_row.max(0.0) as u32).min(image.height())) {
        for x in ((corner[0] - dot).max(0.0) as u32)..((last_column.max(0.0) as u32).min(image.width())) {
            let point = [(x as f32 + 0.5 - corner[0]) / dot, (y as f32 + 0.5 - corner[1]) / dot];
            let nearest = strokes.iter().map(|stroke| distance(point, stroke)).fold(f32::INFINITY, f32::min);
            let cover = (half_width - nearest * dot + 0.5).clamp(0.0, 1.0);
            if cover > 0.0 {
                let under = image.at(x, y);
                let mixed = [0, 1, 2].map(|channel| {
                    let below = f32::from(under[channel]);
                    (below + (f32::from(colour[channel]) - below) * cover).round() as u8
                });
                *image.at_mut(x, y) = mixed;
            }
        }
    }
}

fn distance(point: [f32; 2], [from, to]: &Stroke) -> f32 {
    let along = [to[0] - from[0], to[1] - from[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let offset = [point[0] - from[0], point[1] - from[1]];
    let share = if square > 0.0 {
        ((offset[0] * along[0] + offset[1] * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (offset[0] - share * along[0]).hypot(offset[1] - share * along[1])
}
