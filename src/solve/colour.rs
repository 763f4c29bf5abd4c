//! Graph colouring: contacts of one colour share no movable body, so they can be solved in any order,
//! by any number of threads, with the same bits. Greedy, in the contacts' own order, as in Box2D v3.

/// Colours that run in parallel; what fits in none is the last group and runs in order.
pub const COLOURS: usize = 24;

/// Sorts contacts by colour. Returns the permutation (`order[k]` is the old index of the k-th) and the
/// starts of the groups: `COLOURS` parallel ones and one serial, so `COLOURS + 2` numbers.
pub fn order(
    bodies: &[[u32; 2]],
    movable: impl Fn(u32) -> bool,
    count: usize,
) -> (Vec<u32>, Vec<usize>) {
    let mut used = vec![0u32; count];
    let mut sizes = [0usize; COLOURS + 1];
    let mut colour_of = Vec::with_capacity(bodies.len());
    let all = (1u32 << COLOURS) - 1;
    for [i, j] in bodies {
        let (a, b) = (movable(*i), movable(*j));
        let taken = if a { used[*i as usize] } else { 0 } | if b { used[*j as usize] } else { 0 };
        let free = !taken & all;
        let colour = if free == 0 {
            COLOURS
        } else {
            free.trailing_zeros() as usize
        };
        if colour < COLOURS {
            if a {
                used[*i as usize] |= 1 << colour;
            }
            if b {
                used[*j as usize] |= 1 << colour;
            }
        }
        sizes[colour] += 1;
        colour_of.push(colour as u8);
    }
    let mut starts = vec![0usize; COLOURS + 2];
    for k in 0..=COLOURS {
        starts[k + 1] = starts[k] + sizes[k];
    }
    let mut next = starts.clone();
    let mut order = vec![0u32; bodies.len()];
    for (k, colour) in colour_of.iter().enumerate() {
        let slot = &mut next[*colour as usize];
        order[*slot] = k as u32;
        *slot += 1;
    }
    (order, starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_shares_no_movable_body() {
        let chain: Vec<[u32; 2]> = (0..50).flat_map(|k| [[k, k + 1], [k, 60]]).collect();
        let (order, starts) = order(&chain, |b| b != 60, 61);
        let mut seen = order.clone();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(k, o)| k as u32 == *o));
        for group in starts.windows(2).take(COLOURS) {
            let mut bodies: Vec<u32> = order[group[0]..group[1]]
                .iter()
                .flat_map(|k| chain[*k as usize])
                .filter(|b| *b != 60)
                .collect();
            let n = bodies.len();
            bodies.sort_unstable();
            bodies.dedup();
            assert_eq!(bodies.len(), n);
        }
    }

    #[test]
    fn a_hub_overflows_into_the_serial_group() {
        let star: Vec<[u32; 2]> = (1..100).map(|k| [0, k]).collect();
        let (_, starts) = order(&star, |_| true, 100);
        assert_eq!(starts[COLOURS + 1] - starts[COLOURS], 99 - COLOURS);
    }
}
