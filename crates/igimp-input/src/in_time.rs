//! Conditions of the water and searches that are stated for several times: one of each is made for every time, before the file
//! is checked, so that all that follows knows single ones only.

use igimp_schema::tree::{Entry, Node, Value};

/// Most conditions or stages that are made.
const MOST: usize = 1000;
/// Steps of the stage that brings the water of a time.
const STEPS: i64 = 4;

/// Puts them into the tree. What is not stated as it should be stays, for the checks to find.
pub(super) fn expand(tree: &mut Node) {
    let courses: Vec<(String, Vec<Node>)> = (tree.items_at("water").iter())
        .filter_map(|water| Some((water.text_at("name")?.to_owned(), times(water)?.to_vec())))
        .collect();
    if let Some(Value::List(water)) = tree.get_mut("water").map(|node| &mut node.value) {
        replace(water, |row| {
            let times = times(row)?;
            Some(times.iter().map(|time| condition_at(row, time)).collect())
        });
    }
    if let Some(Value::List(stages)) = tree.get_mut("stages").map(|node| &mut node.value) {
        replace(stages, |row| Some(searches(row, in_time(row, &courses)?)));
    }
}

/// Puts those that are made in the place of those that they are made of, as long as they are not too many.
fn replace(list: &mut Vec<Node>, made_of: impl Fn(&Node) -> Option<Vec<Node>>) {
    let mut made = 0;
    for item in std::mem::take(list) {
        match made_of(&item).filter(|several| made + several.len() <= MOST) {
            Some(several) => {
                made += several.len();
                list.extend(several);
            }
            None => list.push(item),
        }
    }
}

/// The times of a condition that is stated for several.
fn times(condition: &Node) -> Option<&[Node]> {
    let times = condition.get("seepage")?.items_at("times");
    let is_right =
        (1..=MOST).contains(&times.len()) && times.iter().all(|time| time.text().is_some());
    (is_right && condition.text_at("name").is_some()).then_some(times)
}

/// The times at which a stage searches.
fn in_time<'a>(stage: &Node, courses: &'a [(String, Vec<Node>)]) -> Option<&'a [Node]> {
    let water = stage.text_at("in_time")?;
    stage.text_at("name")?;
    let course = courses.iter().find(|(name, _)| name == water)?;
    Some(&course.1)
}

/// A name at a time, of characters that names may have.
fn name_at(name: &str, time: &Node) -> String {
    format!(
        "{name} at {}",
        time.text().unwrap_or_default().replace('.', "_")
    )
}

/// Sets the value of a key, or adds it.
fn set(table: &mut Node, key: &str, value: Value) {
    let place = table.place;
    if let Some(node) = table.get_mut(key) {
        node.value = value;
    } else if let Some(entries) = table.entries_mut() {
        entries.push(Entry {
            key: key.to_owned(),
            key_place: place,
            node: Node::written(value, place),
        });
    }
}

fn remove(table: &mut Node, keys: &[&str]) {
    if let Some(entries) = table.entries_mut() {
        entries.retain(|entry| !keys.contains(&entry.key.as_str()));
    }
}

/// The condition of one time.
fn condition_at(water: &Node, time: &Node) -> Node {
    let mut found = water.clone();
    let name = name_at(water.text_at("name").unwrap_or_default(), time);
    set(&mut found, "name", Value::Text(name));
    if let Some(seepage) = found.get_mut("seepage") {
        remove(seepage, &["times"]);
        set(seepage, "time", time.value.clone());
    }
    found
}

/// A stage that brings the water, and a search, by time; each water follows that of the time before.
fn searches(stage: &Node, times: &[Node]) -> Vec<Node> {
    let text = |key: &str| stage.text_at(key).unwrap_or_default();
    let mut found: Vec<Node> = Vec::new();
    let mut from = stage.get("start_from").map(|node| node.value.clone());
    for time in times {
        let name = name_at(text("name"), time);
        let water_name = format!("{name} (water)");
        let mut water = Node::written(Value::Table(Vec::new()), stage.place);
        set(&mut water, "name", Value::Text(water_name.clone()));
        set(&mut water, "type", Value::Text("construction".to_owned()));
        if let Some(from) = from.replace(Value::Text(water_name)) {
            set(&mut water, "start_from", from);
        }
        set(
            &mut water,
            "water",
            Value::Text(name_at(text("in_time"), time)),
        );
        set(&mut water, "drained", Value::Flag(true));
        set(&mut water, "geometry", Value::Text("given".to_owned()));
        set(&mut water, "steps", Value::Integer(STEPS));
        let mut search = stage.clone();
        remove(&mut search, &["in_time", "start_from"]);
        set(&mut search, "name", Value::Text(name));
        found.extend([water, search]);
    }
    found
}
