// Style sheets are text where a bundle has them inside.
declare module "*.css" {
  const text: string;
  export default text;
}
